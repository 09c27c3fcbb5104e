"""Rows of the table of cells (work array ``cell``): one column per cell, the last one the foil.

New = after the step that is being taken, old = one step before the current state.
"""

T, T_old, T_new = range(3)
"""Temperature [K]."""
T_star = 3
"""T extrapolated to the end of the step."""
inverse_T = 4
"""1 / T*, within the range in which rates and properties follow T."""
fall = 5
"""Half the temperature difference across the cell [K]."""
change = 6
"""-(1/T_new - 1/T*), to first order [1/K]."""
C, C_new = 7, 8
"""Heat capacity per area [J/(m2 K)]."""
d, d_start = 9, 10
"""Thickness [m]; of the foil: of solid with twice the resistance of the contact."""
dk = 11
"""Thickness times conductivity [W/K]."""
half_r = 12
"""Thermal resistance of half the cell [m2 K/W]."""
heat, heat_new = 13, 14
"""Heat used by the reactions in the step [J/m2]."""
source, slope = 15, 16
"""Heat source = source - slope * T_new [W/m2], without conduction."""
right, upper = 17, 18
"""T_new = right + upper * (T_new of the cell below)."""

COUNT = 19
