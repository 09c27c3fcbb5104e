"""Compiled kernels; nothing outside this folder imports numba."""
