"""Results of a study: their files, and the required contents of each."""
