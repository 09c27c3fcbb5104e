"""Sensitivity of signals and costs over time, a step of its own."""
