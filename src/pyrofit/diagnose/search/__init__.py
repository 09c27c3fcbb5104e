"""The search for the effects that the model lacks."""
