"""Results of the diagnosis, a step of its own."""
