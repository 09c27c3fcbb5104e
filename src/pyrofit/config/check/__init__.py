"""Check: rules between the parts of a complete description, and hints at unusual values."""
