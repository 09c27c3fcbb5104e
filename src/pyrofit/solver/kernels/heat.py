"""Heat exchange of the surfaces and conduction through the cells."""

from typing import NamedTuple

from pyrofit.compiled.jit import between, inner, live, loop
from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.solver.arrays import Number
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.functions import exp, fma, log, nearly_inverse
from pyrofit.solver.kernels.lanes import opposite, somewhere, where
from pyrofit.solver.kernels.radiation import is_opaque, mean_depth, optical_depth
from pyrofit.solver.kernels.reactions import TINY

SIGMA = STEFAN_BOLTZMANN


class Front(NamedTuple):
    """Heat that enters through the front: gain - slope * T_new, and inside the cells [W/m2]."""

    gain: Number
    slope: Number
    inside: Number
    """Radiation that does not stop at the surface, less the part that leaves at the back."""


class Edge(NamedTuple):
    """Where the sample begins: cells that have left the grid are ahead of it."""

    first: int
    """The first cell on the grid, of all lanes."""
    behind: int
    """One behind the last that is the first in a lane."""
    at: Number
    """The first cell in each lane."""


@inner
def approach(t, time):
    """Return 1 - exp(-t/time), the share reached of a value approached with a time constant."""
    if not somewhere(time > 0.0):
        return 1.0 + 0.0 * time
    return where(time > 0.0, 1.0 - exp(-t / max(time, TINY)), 1.0)


@inner
def irradiation(given, t, exposure):
    """Return q_ext(t): the given flux with the heater's rise and drift, plus the flame's."""
    rest = exposure.drift_time
    drifted = where(rest > 0.0, rest * approach(t, rest), t)
    heater = given.flux * approach(t, exposure.rise_time) * max(1.0 + exposure.drift * drifted, 0.0)
    return heater + given.flame


@inner
def above_gas(surface, air, T, t):
    """Return by how much a surface is warmer than the gas [K]."""
    return T - air.gas - surface.gas_rise * approach(t, surface.gas_rise_time)


@inner
def convection(surface, air, dT):
    """Return the heat transfer coefficient of a surface by dT warmer than the gas [W/(m2 K)]."""
    h = air.h
    if somewhere(surface.h_cube_root != 0.0):
        h = h + surface.h_cube_root * exp((1.0 / 3.0) * log(max(abs(dT), 1e-150)))
    return h


@inner
def exchange(surface, air, emissivity, T, t):
    """Linearise the loss of a surface about T: net gain = gain - slope * T_new [W/m2]."""
    dT = above_gas(surface, air, T, t)
    h = convection(surface, air, dT)
    cube = T * T * T
    slope = 4.0 * emissivity * SIGMA * cube + h
    wall = air.wall
    gain = emissivity * SIGMA * (wall * wall * wall * wall - cube * T) - h * dT + slope * T
    return gain, slope


@inner
def at_edge(cell, to, edge):
    """Return a row's value in the first cell of each lane."""
    value = cell[to, edge.first]
    for n in between(edge.first + 1, edge.behind):
        value = where(edge.at == 1.0 * n, cell[to, n], value)
    return value


@inner
def add_at_edge(cell, to, edge, value):
    """Add to a row's value in the first cell of each lane."""
    for n in between(edge.first, edge.behind):
        cell[to, n] += where(edge.at == 1.0 * n, value, 0.0)


@loop
def absorb(radiation, r_skin, work, edge, material):
    """Add the radiation that each cell absorbs to its source.

    Return the radiation that passes through all, and the part that acts at the front. The front
    and the first cell's centre share the part absorbed by skin and first half cell according to
    its resistances to these.
    """
    cell = work.cell
    half = at_edge(cell, row.half_r, edge)
    skin = optical_depth(work.skin, 0, material, at_edge(cell, row.T_star, edge))
    passing = radiation * exp(-skin)
    at_front = (radiation - passing) * (1.0 - mean_depth(skin) * r_skin / (r_skin + half))
    add_at_edge(cell, row.source, edge, radiation - passing - at_front)
    for n in live(work.m, edge.first):
        optical = optical_depth(work.m_new, n, material, cell[row.T_star, n])
        passed = passing * exp(-optical)
        share = half * (1.0 - 2.0 * mean_depth(optical)) / (r_skin + half)
        forward = where(edge.at == 1.0 * n, share * (passing - passed), 0.0)
        at_front += forward
        cell[row.source, n] += passing - passed - forward
        passing = passed
    return passing, at_front


@inner
def edge_of_cell(work, n, exposure):
    """Return the conductance of a cell's edge [W/(m2 K)]; the backing has none."""
    behind = 1.0 * n >= work.m.shape[1] - exposure.backing_cells
    return where(behind, 0.0, exposure.edge_exchange * work.cell[row.d, n])


@inner
def lose_at_edge(work, first, exposure):
    """Add to every cell of the sample the heat its edge exchanges with the gas beside it."""
    cell = work.cell
    for n in live(work.m, first):
        loss = edge_of_cell(work, n, exposure)
        cell[row.slope, n] += loss
        cell[row.source, n] += loss * exposure.edge_temperature


@inner
def surface_heat(radiation, eps, front_star, t, given, r_skin, work, edge, material, exposure):
    """Fill the heat source of the foil and return that of the front, about T*."""
    cell = work.cell
    foil = work.m.shape[1]
    gain, slope = exchange(exposure.front, given.front, eps, front_star, t)
    gain_back, slope_back = exchange(
        exposure.back, given.back, exposure.back_emissivity, cell[row.T_star, foil], t
    )
    inside = 0.0 * gain
    opaque = is_opaque(material)
    at_front = radiation
    if somewhere(opposite(opaque)):
        kept = where(opaque, 0.0, exposure.surface_share * radiation)
        entering = where(opaque, 0.0, radiation) - kept
        transmitted, at_front = absorb(entering, r_skin, work, edge, material)
        inside = entering - at_front - transmitted
        at_front = where(opaque, radiation, at_front + kept)
        if exposure.back_absorbs:
            gain_back += transmitted
    cell[row.source, foil] = gain_back
    cell[row.slope, foil] = slope_back
    return Front(gain + at_front, slope, inside)


@loop
def heat_gas(work, edge, foil, exposure):
    """Take from every cell the heat taken up by the gas that passes; return the sum [W/m2].

    A cell with the gas flux G in its middle and the temperature fall dT over it loses c_g G dT.
    """
    cell = work.cell
    passing = 0.0 * cell[row.rate, edge.first]
    taken = 0.0 * passing
    for n in range(foil - 1, edge.first - 1, -1):
        rate = cell[row.rate, n]
        heat = exposure.gas_heat * (passing + 0.5 * rate) * 2.0 * cell[row.fall, n]
        heat = where(edge.at <= 1.0 * n, heat, 0.0)
        cell[row.source, n] -= heat
        taken += heat
        passing += rate
    return taken


@inner
def net_flux(surface, front, work, first, exposure):
    """Return the heat that enters through surfaces and edge at the end of the step [W/m2]."""
    cell = work.cell
    foil = work.m.shape[1]
    flux = cell[row.source, foil] - cell[row.slope, foil] * cell[row.T_new, foil]
    if somewhere(exposure.edge_exchange != 0.0):
        for n in live(work.m, first):
            loss = edge_of_cell(work, n, exposure)
            flux += loss * (exposure.edge_temperature - cell[row.T_new, n])
    return surface.gain - surface.slope * front + surface.inside + flux


@inner
def temperature_falls(cell, foil, edge, front_star):
    """Fill half the temperature difference across each cell [K]."""
    last = foil - 1
    # Before the foil the resistance of the contact counts as solid, of thickness k R.
    cell[row.d, last + 1] = cell[row.d, last] * cell[row.half_r, last + 1] / cell[row.half_r, last]
    for n in between(edge.first + 1, last + 1):
        d = cell[row.d, n]
        span = 0.5 * (cell[row.d, n - 1] + cell[row.d, n + 1]) + d
        across = cell[row.T_star, n - 1] - cell[row.T_star, n + 1]
        cell[row.fall, n] = 0.5 * across * d * nearly_inverse(max(span, TINY))
    for n in between(edge.first, edge.behind):
        across = front_star - cell[row.T_star, n]
        cell[row.fall, n] = where(edge.at == 1.0 * n, across, cell[row.fall, n])


class Solved(NamedTuple):
    """The temperatures found, and the rate that was predicted before."""

    front: Number
    """Front temperature [K]."""
    coldest: Number
    hottest: Number
    rate: Number
    """Predicted mass loss rate at the end [kg/(m2 s)]."""


@inner
def eliminate(cell, n, below, seen, carried, bdf):
    """Eliminate row n of the system; return ``seen`` and ``carried`` of the next, see `conduct`."""
    C = bdf.b1 * cell[row.C_mean, n]
    alone = C + cell[row.slope, n]
    # A row waits for the one above: for a sum, the division and one product.
    inverse_sum = 1.0 / ((alone + below) + seen)
    heat = fma(C, cell[row.T, n], cell[row.source, n]) + carried
    upper = below * inverse_sum
    cell[row.right, n] = heat * inverse_sum
    cell[row.upper, n] = upper
    return ((alone + seen) * below) * inverse_sum, heat * upper


@inner
def conduct(cell, foil, edge, surface, r_skin, bdf):
    """Solve C_mean dT/dt = conduction + source for T_new.

    Elimination from the front: ``seen`` is the conductance to the surroundings through all that
    lies above a row, ``carried`` the heat that comes that way.
    """
    lead = r_skin + at_edge(cell, row.half_r, edge)
    couple = 1.0 / (1.0 + surface.slope * lead)
    seen = surface.slope * couple
    carried = surface.gain * couple
    rate = 0.0 * seen
    for n in between(edge.first, foil):
        rate += cell[row.rate, n]
        below = nearly_inverse(cell[row.half_r, n] + cell[row.half_r, n + 1])
        seen_below, carried_below = eliminate(cell, n, below, seen, carried, bdf)
        if n + 1 < edge.behind:
            ahead = edge.at > 1.0 * n
            seen_below = where(ahead, seen, seen_below)
            carried_below = where(ahead, carried, carried_below)
            cell[row.right, n] = where(ahead, 0.0, cell[row.right, n])
            cell[row.upper, n] = where(ahead, 1.0, cell[row.upper, n])
        seen, carried = seen_below, carried_below
    eliminate(cell, foil, 0.0, seen, fma(bdf.b3, cell[row.stored_old, foil], carried), bdf)
    T = cell[row.right, foil]
    cell[row.T_new, foil] = T
    coldest, hottest = T, T
    for n in range(foil - 1, edge.first - 1, -1):
        T = fma(cell[row.upper, n], T, cell[row.right, n])
        cell[row.T_new, n] = T
        coldest, hottest = min(coldest, T), max(hottest, T)
    front = (surface.gain * lead + T) * couple
    return Solved(front, min(coldest, front), max(hottest, front), rate)
