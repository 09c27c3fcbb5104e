"""Physical constants (CODATA 2018), SI units, and a number of statistics."""

GAS_CONSTANT = 8.314462618
"""Molar gas constant R [J/(mol K)]."""

STEFAN_BOLTZMANN = 5.670374419e-8
"""Stefan-Boltzmann constant sigma [W/(m2 K4)]."""

QUANTILE = 1.96
"""Half of a 95 % interval of a normal distribution, in standard deviations.

Chi-square rises by its square, 3.84.
"""
