"""The work arrays of a slab run."""

from typing import NamedTuple

import numpy as np

from pyrofit.compiled.jit import making
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.lanes import in_lanes

ALIGNED = 8
"""Numbers in a line of the processor's cache, at which registers are loaded best."""


class Work(NamedTuple):
    """Symbols: i component; j reaction; n cell, front first; new = after the step.

    The arrays are looked at in three ways. As *numbers* they have the shapes given here. As plain
    *floats*, in which single lanes are reached, they have an axis more, the lanes. *Wide*, for
    operations on all cells alike, an element fills a register. It is a cell in all lanes, or, of a
    set that runs alone, several cells.
    """

    cell: FloatArray
    """Rows listed in `row`, shape (rows, cells + 1 or more); the foil is behind the last cell."""
    m: FloatArray
    """Masses [kg/m2], shape (components, cells), like ``m_new``, ``formed`` and ``formed_new``."""
    m_new: FloatArray
    formed: FloatArray
    """Mass ever present, the reference of the reaction order."""
    formed_new: FloatArray
    root: FloatArray
    """Square root of k_j [1/s^0.5], shape (reactions, cells)."""
    root_new: FloatArray
    held: FloatArray
    """u^(n-1) at the start of the step, u = m over the mass ever present, shape (reactions, cells);
    where each reaction has its own reactant."""
    skin: FloatArray
    """Masses of the cells that left the grid [kg/m2], shape (components, 1)."""
    open: FloatArray
    """Factor of k_j by the oxygen at the surface, mean of the step, shape (reactions,); a number
    also where the others are wide, as the next four."""
    open_end: FloatArray
    """The same at the end of the step."""
    full: FloatArray
    """The same where the oxygen at the surface is that of the gas."""
    need: FloatArray
    """Oxygen that reaction j would use up over that which convection could supply."""
    burning: FloatArray
    """Heat per mass of reactant that a reaction releases as it burns [J/kg], same shape."""


class Room(NamedTuple):
    """Room to work on one (wide) cell, shape (reactions,)."""

    x: FloatArray
    """Integral of k_j over the step, then of k_j u^(n-1)."""
    growth: FloatArray
    """d x_j / d ln k_j."""
    used: FloatArray
    """Mass consumed by each reaction in the step [kg/m2]."""
    behind: FloatArray
    """Factor of the reaction's order on k_j at the end of the step."""


class Arrays(NamedTuple):
    """The work arrays of a run in the three ways they are looked at, and room for a cell."""

    flat: Work
    """As plain floats."""
    work: Work
    """As numbers."""
    wide: Work
    room: Room


@making
def allocate(cells, behind, components, reactions, lanes):
    """Return the work arrays of a run as floats, all zero, with room behind the cells."""
    columns = cells + behind
    of_cells = row.COUNT * columns
    of_masses = 4 * components * cells
    of_rates = 3 * reactions * cells
    raw = np.zeros((of_cells + of_masses + of_rates + components + 5 * reactions) * lanes + ALIGNED)
    free = raw[-(np.int64(raw.ctypes.data) // 8) % ALIGNED :]
    cell = free[: of_cells * lanes].reshape(row.COUNT, columns, lanes)
    free = free[of_cells * lanes :]
    masses = free[: of_masses * lanes].reshape(4, components, cells, lanes)
    free = free[of_masses * lanes :]
    rates = free[: of_rates * lanes].reshape(3, reactions, cells, lanes)
    free = free[of_rates * lanes :]
    of_reactions = free[components * lanes :][: 5 * reactions * lanes]
    factors = of_reactions.reshape(5, reactions, lanes)
    return Work(
        cell=cell,
        m=masses[0],
        m_new=masses[1],
        formed=masses[2],
        formed_new=masses[3],
        root=rates[0],
        root_new=rates[1],
        held=rates[2],
        skin=free[: components * lanes].reshape(components, 1, lanes),
        open=factors[0],
        open_end=factors[1],
        full=factors[2],
        need=factors[3],
        burning=factors[4],
    )


@making
def in_width(width, flat, lanes):
    """Return work arrays whose elements hold so many floats; ``lanes`` those of a number."""
    w = len(width)
    return Work(
        cell=in_lanes(width, flat.cell.reshape(flat.cell.shape[0], -1, w)),
        m=in_lanes(width, flat.m.reshape(flat.m.shape[0], -1, w)),
        m_new=in_lanes(width, flat.m_new.reshape(flat.m.shape[0], -1, w)),
        formed=in_lanes(width, flat.formed.reshape(flat.m.shape[0], -1, w)),
        formed_new=in_lanes(width, flat.formed_new.reshape(flat.m.shape[0], -1, w)),
        root=in_lanes(width, flat.root.reshape(flat.root.shape[0], -1, w)),
        root_new=in_lanes(width, flat.root_new.reshape(flat.root.shape[0], -1, w)),
        held=in_lanes(width, flat.held.reshape(flat.root.shape[0], -1, w)),
        skin=in_lanes(width, flat.skin),
        open=in_lanes(lanes, flat.open),
        open_end=in_lanes(lanes, flat.open_end),
        full=in_lanes(lanes, flat.full),
        need=in_lanes(lanes, flat.need),
        burning=in_lanes(lanes, flat.burning),
    )


@making
def make_room(width, reactions):
    """Return room to work on a cell."""
    raw = np.zeros(4 * reactions * len(width) + ALIGNED)
    free = raw[-(np.int64(raw.ctypes.data) // 8) % ALIGNED :]
    room = free[: 4 * reactions * len(width)].reshape(4, reactions, len(width))
    return Room(
        in_lanes(width, room[0]),
        in_lanes(width, room[1]),
        in_lanes(width, room[2]),
        in_lanes(width, room[3]),
    )


@making
def make_arrays(width, wide, cells, components, reactions):
    """Return the work arrays of a run, all zero."""
    lanes = len(width)
    flat = allocate(cells, len(wide) // lanes, components, reactions, lanes)
    work, in_registers = in_width(width, flat, width), in_width(wide, flat, width)
    return Arrays(flat, work, in_registers, make_room(wide, reactions))
