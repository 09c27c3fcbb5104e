"""The state of a slab: its start, its change by a step, and the cells that leave the grid."""

from pyrofit.compiled.jit import between, inner, live, loop
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.cells import (
    describe,
    fill_rate_constants,
    layer,
    reactant_in_lane,
    reactant_left,
)
from pyrofit.solver.kernels.lanes import opposite, somewhere, where
from pyrofit.solver.kernels.oxygen import begin_depths, close, fill_in_depth
from pyrofit.solver.kernels.step import summed
from pyrofit.solver.kernels.trace import Size

DEAD_FRACTION = 1.0e-7
"""Reactant left, relative to the cell's initial mass, below which a cell may leave the grid."""
OWN = -1
"""Stands for the number of those cells that are burnt and thin."""
THIN_FRACTION = 0.01
"""Residue thickness, relative to the cell's initial one, below which a cell may leave the grid."""


@inner
def begin(work, wide, description, T_start):
    """Fill temperatures, properties and rates of the initial state."""
    cell = work.cell
    foil = work.m.shape[1]
    for n in live(cell, 0):
        cell[row.T, n] = T_start
        cell[row.T_old, n] = T_start
        cell[row.T_star, n] = T_start
    describe(wide, 0, description.material)
    fill_rate_constants(wide, 0, description.network)
    close(work, 0.0 * T_start, description.network)
    if description.network.oxidises:
        begin_depths(work)
        fill_in_depth(wide, 0, description.network)
    for n in live(wide.m, 0):
        wide.cell[row.dead, n] = DEAD_FRACTION * mass_of(wide.m, n)
        wide.cell[row.C, n] = wide.cell[row.C_new, n]
        wide.cell[row.d_start, n] = wide.cell[row.d, n]
        for j in range(wide.root.shape[0]):
            wide.root[j, n] = wide.root_new[j, n]
    cell[row.C_mean, foil] = description.exposure.foil_capacity
    cell[row.half_r, foil] = description.exposure.contact_resistance


@inner
def mass_of(m, n):
    """Return the mass of a cell [kg/m2]."""
    mass = 0.0 * m[0, n]
    for i in range(m.shape[0]):
        mass += m[i, n]
    return mass


@inner
def fill(work, start):
    """Give the cells their masses."""
    for i in range(work.m.shape[0]):
        for n in live(work.m, 0):
            work.m[i, n] = start[n, i]
            work.m_new[i, n] = start[n, i]
            work.formed[i, n] = start[n, i]


@loop
def accept(wide, first, network, accepted):
    """Make the state after the step the current one, in the lanes in which it was accepted."""
    if somewhere(opposite(accepted)):
        move(wide, first, network, False, accepted)
    else:
        move(wide, first, network, True, accepted)


@inner
def move(wide, first, network, every, accepted):
    """Move the state after the step to where the current one is, maybe in every lane."""
    cell = wide.cell
    for n in live(cell, first):
        T, stored = cell[row.T, n], cell[row.stored_old, n]
        cell[row.T_old, n] = taken(every, accepted, T, cell[row.T_old, n])
        cell[row.T, n] = taken(every, accepted, cell[row.T_new, n], T)
        cell[row.stored_old, n] = taken(every, accepted, cell[row.stored, n], stored)
    for n in live(wide.m, first):
        cell[row.C, n] = taken(every, accepted, cell[row.C_new, n], cell[row.C, n])
        cell[row.rate_old, n] = taken(every, accepted, cell[row.rate, n], cell[row.rate_old, n])
        for i in range(wide.m.shape[0]):
            wide.m[i, n] = taken(every, accepted, wide.m_new[i, n], wide.m[i, n])
        for j in range(wide.root.shape[0]):
            wide.root[j, n] = taken(every, accepted, wide.root_new[j, n], wide.root[j, n])
    if network.oxidises:
        for n in live(wide.m, first):
            depth = cell[row.depth, n]
            cell[row.depth_old, n] = taken(every, accepted, depth, cell[row.depth_old, n])
            cell[row.depth, n] = taken(every, accepted, cell[row.depth_new, n], depth)
    if not (network.first_order or network.plain):
        for i in range(wide.m.shape[0]):
            for n in live(wide.m, first):
                formed = taken(every, accepted, wide.formed_new[i, n], wide.formed[i, n])
                wide.formed[i, n] = formed


@inner
def taken(every, accepted, new, old):
    """Return the new number in the lanes in which it was accepted, maybe in every one."""
    if every:
        return new
    return where(accepted, new, old)


@inner
def may_drop(work, edge, taken, network):
    """Tell whether the first cell of some lane may leave the grid after a step taken."""
    cell = work.cell
    found = taken != taken
    for n in between(edge.first, edge.behind):
        burnt = reactant_left(work.m, n, network) < cell[row.dead, n]
        thin = cell[row.d, n] <= THIN_FRACTION * cell[row.d_start, n]
        found = found | ((edge.at == 1.0 * n) & burnt & thin)
    return somewhere(found & (taken == 1.0))


@inner
def is_thin(flat, lane, n, network):
    """Tell whether a cell is burnt and thin."""
    cell = flat.cell
    burnt = reactant_in_lane(flat.m, n, lane, network) < cell[row.dead, n, lane]
    return burnt and cell[row.d, n, lane] <= THIN_FRACTION * cell[row.d_start, n, lane]


@inner
def drop_thin(flat, lane, first, network, count):
    """Move cells to the skin, those that are burnt and thin, or as many as ``count`` says.

    Return the first one left, and the heat stored.
    """
    cell = flat.cell
    heat, behind = 0.0, first + count
    while first < flat.m.shape[1] - 1:
        if first >= behind if count != OWN else not is_thin(flat, lane, first, network):
            break
        for i in range(flat.m.shape[0]):
            flat.skin[i, 0, lane] += flat.m[i, first, lane]
            flat.m[i, first, lane] = 0.0
        C = cell[row.C, first, lane]
        cell[row.d, first, lane] = 0.0
        cell[row.C, first, lane] = 0.0
        cell[row.C, first + 1, lane] += C
        cell[row.stored_old, first + 1, lane] += cell[row.stored_old, first, lane]
        heat += C * (cell[row.T, first + 1, lane] - cell[row.T, first, lane])
        first += 1
    return first, heat


@inner
def may_be_burnt(work, limit, network):
    """Tell in which lanes the last cell has no more reactant than the limit [kg/m2]."""
    return reactant_left(work.m, work.m.shape[1] - 1, network) <= limit


@inner
def is_burnt_out(flat, lane, first, network, limit):
    """Tell whether no more reactant than the limit [kg/m2] is left."""
    left = 0.0
    for n in range(flat.m.shape[1] - 1, first - 1, -1):
        left += reactant_in_lane(flat.m, n, lane, network)
        if left > limit:
            return False
    return True


@inner
def total_mass(work):
    """Return the mass of all cells and of the skin [kg/m2]."""
    mass = 0.0 * work.skin[0, 0]
    for i in range(work.m.shape[0]):
        mass += work.skin[i, 0]
        for n in live(work.m, 0):
            mass += work.m[i, n]
    return mass


@inner
def size_of(work, first, T, description):
    """Return how thick the samples are, whose skins have the temperature T."""
    skin, r_skin, _ = layer(work.skin, 0, description.material, T)
    depth = skin + summed(work, row.d, first) - description.exposure.backing_thickness
    return Size(depth, skin, r_skin)
