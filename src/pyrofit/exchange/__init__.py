"""Into other programs and back: what of a study they can express, and files that they read."""
