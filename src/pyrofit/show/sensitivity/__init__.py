"""What signals and costs depend on, over time, a step of its own."""
