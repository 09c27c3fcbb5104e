"""Names of the methods."""

METHODS = {"friedman": "Friedman", "kas": "KAS", "vyazovkin": "advanced Vyazovkin"}
"""In words, in the order of the table."""
NOTHING = (
    "Nothing speaks against one reaction: the activation energy does not vary with conversion by "
    "more than its errors, and the fitted model has the same."
)
