"""The base model, its fit, and whether it is adequate."""
