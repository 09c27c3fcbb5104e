"""The work arrays of a slab run."""

from typing import NamedTuple

import numpy as np

from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.jit import entry


class Work(NamedTuple):
    """Symbols: i component; j reaction; n cell, front first; new = after the step.

    The cells come last, so that the loops over them are vectorised.
    """

    cell: FloatArray
    """What `row` lists, shape (rows, cells + 1); the last column is the foil."""
    m: FloatArray
    """Masses [kg/m2], shape (components, cells), like ``m_new``, ``formed`` and ``v``."""
    m_new: FloatArray
    formed: FloatArray
    """Mass ever present, the reference of the reaction order."""
    v: FloatArray
    """Volumes per area [m]."""
    skin: FloatArray
    """What the cells that left the grid have left behind, shape (components, 1)."""
    k: FloatArray
    """k_j [1/s], shape (reactions, cells), like all below."""
    k_new: FloatArray
    x: FloatArray
    """Integral of k_j over the step."""
    growth: FloatArray
    """d x_j / d ln k_j."""
    left: FloatArray
    """Mass that r_j is proportional to, r_j / k_j [kg/m2]."""
    used: FloatArray
    """Mass consumed by each reaction in the step [kg/m2]."""


@entry
def allocate(start, T_start, reactions):
    """Return the work arrays of a run that starts with the given masses and temperature."""
    cells, components = start.shape
    cell = np.zeros((row.COUNT, cells + 1))
    cell[row.T] = T_start
    cell[row.T_old] = T_start
    cell[row.T_star] = T_start
    m = np.ascontiguousarray(start.T)
    per_reaction = np.zeros((6, reactions, cells))
    return Work(
        cell=cell,
        m=m,
        m_new=m.copy(),
        formed=m.copy(),
        v=np.zeros((components, cells)),
        skin=np.zeros((components, 1)),
        k=per_reaction[0],
        k_new=per_reaction[1],
        x=per_reaction[2],
        growth=per_reaction[3],
        left=per_reaction[4],
        used=per_reaction[5],
    )
