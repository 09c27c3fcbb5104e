"""The diagnosis as files and words."""
