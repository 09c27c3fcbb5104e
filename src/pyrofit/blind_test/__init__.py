"""The blind test of the diagnosis: twins whose truth has an effect that the model lacks."""
