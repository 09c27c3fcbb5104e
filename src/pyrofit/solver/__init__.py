"""Solvers: plain arrays in, plain arrays and a status out."""
