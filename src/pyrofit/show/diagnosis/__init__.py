"""What the diagnosis found, a step of its own."""
