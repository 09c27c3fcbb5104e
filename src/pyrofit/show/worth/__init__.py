"""By how much planned tests narrow parameters and predictions, a step of its own."""
