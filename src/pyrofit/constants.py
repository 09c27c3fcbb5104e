"""Physical constants (CODATA 2018), those of air, SI units, and a number of statistics."""

GAS_CONSTANT = 8.314462618
"""Molar gas constant R [J/(mol K)]."""

STEFAN_BOLTZMANN = 5.670374419e-8
"""Stefan-Boltzmann constant sigma [W/(m2 K4)]."""

OXYGEN_OVER_AIR = 31.9988 / 28.965
"""Ratio of the molar masses of oxygen and air."""

AIR_HEAT_CAPACITY = 1010.0
"""Specific heat of air c_p [J/(kg K)]; h/c_p is the mass transfer coefficient at Lewis number 1."""

QUANTILE = 1.96
"""Half of a 95 % interval of a normal distribution, in standard deviations.

Chi-square rises by its square, 3.84.
"""
