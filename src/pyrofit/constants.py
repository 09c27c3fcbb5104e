"""Physical constants (CODATA 2018), SI units."""

GAS_CONSTANT = 8.314462618
"""Molar gas constant R [J/(mol K)]."""

STEFAN_BOLTZMANN = 5.670374419e-8
"""Stefan-Boltzmann constant sigma [W/(m2 K4)]."""
