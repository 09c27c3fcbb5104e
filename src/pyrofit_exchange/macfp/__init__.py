"""Parameter sets, predictions and submissions of the MaCFP data base."""
