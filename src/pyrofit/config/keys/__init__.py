"""Keys: everything that may stand in a study, as parts that check themselves."""
