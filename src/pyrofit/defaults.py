"""Options of the steps unless told otherwise, for the steps and for the help of their commands.

They are apart from the steps, as a command loads its step only when it runs.
"""

DRAWS = 50
"""Drawn data sets that check the worth of planned tests: half a minute."""
APPARATUS = "exact"
"""Whether their apparatus is as described."""
