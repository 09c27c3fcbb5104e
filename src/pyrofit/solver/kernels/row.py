"""Rows of the table of cells (work array ``cell``): one column per cell, then the foil.

New is after the step that is being taken, old is one step before the current state. Rate, heat,
gas and stored belong to the step that is being taken, their old ones to the step before.
"""

T, T_old, T_new = range(3)
"""Temperature [K]."""
T_star = 3
"""T extrapolated to the end of the step."""
inverse_T = 4
"""1 / T*, within the range in which rates and properties follow T."""
fall = 5
"""Half the temperature difference across the cell [K]."""
C, C_new, C_mean = 6, 7, 8
"""Heat capacity per area [J/(m2 K)], and its mean over the step."""
C_lost = 9
"""The part of C due to the masses lost in the step, at T*."""
d, d_start = 10, 11
"""Thickness [m]; of the foil: of solid with twice the resistance of the contact."""
half_r = 12
"""Thermal resistance of half the cell [m2 K/W]."""
heat = 13
"""Heat used by the reactions in the step [J/m2]."""
source, slope = 14, 15
"""Heat source = source - slope * T_new [W/m2], without conduction. That of a cell includes the heat
that the formula carries over from the step before."""
right, upper = 16, 17
"""T_new = right + upper * (T_new of the cell below)."""
rate, rate_old = 18, 19
"""Gas released per time at the end of the step, and at its start [kg/(m2 s)]."""
gas = 20
"""Gas released in the step [kg/m2]."""
stored, stored_old = 21, 22
"""Heat stored in the step, and used by the reactions [J/m2]."""
dk = 23
"""Thickness times conductivity [W/K]."""
grows = 24
"""T^2 times the slope of the reaction heat in T [J K/m2]."""
burnt, power = 25, 26
"""Heat of combustion of the gas released in the step [J/m2], and per time at its end [W/m2]."""
dead = 27
"""Mass that can react [kg/m2] below which the cell may leave the grid."""
bend = 28
"""Rise of ln k over the half cell, or of half of it from T* to T_new, over E/R [1/K]."""

depth, depth_old, depth_new = 29, 30, 31
"""Depth of the middle of the cell below the surface [m]; where reactions need oxygen."""
deeper = 32
"""Its change from the extrapolated to the computed one of the step [m]."""

COUNT = 33
