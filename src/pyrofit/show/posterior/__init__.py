"""Draws from the posterior of the parameters, a step of its own."""
