"""Names of the methods."""

METHODS = {"friedman": "Friedman", "kas": "KAS", "vyazovkin": "advanced Vyazovkin"}
"""In words, in the order of the table."""
