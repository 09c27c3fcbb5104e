"""Compiled loops over matrices: sums in the order that they state, on every processor."""
