"""Exchange with other programs: the parts of a study that they can express, and their files."""
