"""One run of a study at a time, and one study throughout a run."""
