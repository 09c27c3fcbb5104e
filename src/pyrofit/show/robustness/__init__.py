"""Cost functions on twins of known truth, a step of its own."""
