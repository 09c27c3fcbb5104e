"""How stable the result of a diagnosis is."""
