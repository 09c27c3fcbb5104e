"""What each measured file of a folder is, and what looks wrong in it."""
