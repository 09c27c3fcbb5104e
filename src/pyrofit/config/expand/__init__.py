"""Expand: from the keys of a file to a complete description."""
