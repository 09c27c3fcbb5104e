"""The trace of a run: a row for every step, lane by lane."""

import math
from typing import NamedTuple

from pyrofit.solver.arrays import FloatArray, Number
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.jit import inner
from pyrofit.solver.kernels.lanes import in_lane
from pyrofit.solver.kernels.reactions import TINY

TIME, RELEASED, RATE, FRONT, BACK, THICKNESS, BURNT, POWER, KINK, PROBES = range(10)
"""Columns of the trace; any number of probes, those that follow the material first."""
STATUS, STEPS, ENERGY_ERROR, MASS_ERROR = range(4)
"""Columns of the outcome of a run."""


class Written(NamedTuple):
    """The output of a run."""

    trace: FloatArray
    """Shape (lanes, steps + 1, columns)."""
    outcome: FloatArray
    """Shape (lanes, 4)."""


class Size(NamedTuple):
    """How thick a sample is."""

    depth: Number
    """Without the inert layers behind it [m]."""
    d_skin: Number
    """Of the cells that left the grid [m]."""
    r_skin: Number
    """Thermal resistance of these [m2 K/W]."""


@inner
def between_cells(upper, lower, r_upper, r_lower):
    """Return T where two parts meet whose T is known behind the resistances r: one heat flux."""
    return upper + r_upper / (r_upper + r_lower) * (lower - upper)


@inner
def in_cell(n, part, cell, lane, first, front, r_skin):
    """Return T in cell n, ``part`` of which lies above; linear in each of its halves."""
    here, half_r = cell[row.T, n, lane], cell[row.half_r, n, lane]
    if part >= 0.5:
        below, r_below = cell[row.T, n + 1, lane], cell[row.half_r, n + 1, lane]
        end = between_cells(here, below, half_r, r_below)
        return here + (2.0 * part - 1.0) * (end - here)
    if n == first:
        end = between_cells(front, here, r_skin, half_r)
    else:
        above, r_above = cell[row.T, n - 1, lane], cell[row.half_r, n - 1, lane]
        end = between_cells(above, here, r_above, half_r)
    return end + 2.0 * part * (here - end)


@inner
def of_material(position, ahead, cell, foil, lane, first, front, r_skin):
    """Return T at a Lagrangian place; that of the front once its cell has left the grid.

    It is counted in cells from the front of the virgin sample, ``ahead`` of which are empty ones.
    """
    above = min(math.floor(position), foil - 1 - ahead)
    if above + ahead < first:
        return front
    return in_cell(above + ahead, position - above, cell, lane, first, front, r_skin)


@inner
def of_fixture(height, cell, foil, lane, first, front, d_skin, r_skin):
    """Return T at a height above the back face; that of the front where the sample is thinner."""
    n, behind = foil - 1, 0.0
    while n > first and behind + cell[row.d, n, lane] < height:
        behind += cell[row.d, n, lane]
        n -= 1
    d = cell[row.d, n, lane]
    above = height - behind - d
    if above <= 0.0:
        return in_cell(n, min(-above / max(d, TINY), 1.0), cell, lane, first, front, r_skin)
    if above >= d_skin:
        return front
    top = between_cells(front, cell[row.T, first, lane], r_skin, cell[row.half_r, first, lane])
    return top + above / d_skin * (front - top)


@inner
def record(trace, lane, numbers, flat, first, ahead, probes):
    """Write one row of the trace of a lane.

    The numbers: time, mass released, rate, front T, thickness, heat of combustion, that per time,
    step length, thickness and resistance of the skin. The step length is that of the step that the
    next one continues, infinite where the flux has a kink.
    """
    t, released, rate, front, depth, burnt, power, before, d_skin, r_skin = numbers
    cell, foil = flat.cell, flat.m.shape[1]
    trace[TIME] = in_lane(t, lane)
    trace[RELEASED] = in_lane(released, lane)
    trace[RATE] = in_lane(rate, lane)
    trace[FRONT] = in_lane(front, lane)
    trace[BACK] = cell[row.T, foil, lane]
    trace[THICKNESS] = in_lane(depth, lane)
    trace[BURNT] = in_lane(burnt, lane)
    trace[POWER] = in_lane(power, lane)
    trace[KINK] = 1.0 if in_lane(before, lane) == math.inf else 0.0
    T, d, r = in_lane(front, lane), in_lane(d_skin, lane), in_lane(r_skin, lane)
    to = PROBES
    for a in range(probes.material.shape[1]):
        place = probes.material[lane, a]
        trace[to] = of_material(place, ahead[lane], cell, foil, lane, first, T, r)
        to += 1
    for a in range(probes.fixture.shape[1]):
        trace[to] = of_fixture(probes.fixture[lane, a], cell, foil, lane, first, T, d, r)
        to += 1
