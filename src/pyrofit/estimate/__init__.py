"""Estimation of parameters: the problem, and the optimisers that solve it."""
