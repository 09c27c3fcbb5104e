"""The trace of a run: a row for every step, lane by lane."""

import math
from typing import NamedTuple

from pyrofit.compiled.jit import inner, loop
from pyrofit.solver.arrays import FloatArray, Number
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.lanes import in_lane, where
from pyrofit.solver.kernels.reactions import TINY

TIME, RELEASED, RATE, FRONT, BACK, THICKNESS, BURNT, POWER, KINK, TAKEN, PROBES = range(11)
"""Columns of the trace; any number of probes, those that follow the material first. Of every step
tried there is a row; `TAKEN` is 1 in the lanes in which it was accepted."""
STATUS, STEPS, ENERGY_ERROR, MASS_ERROR = range(4)
"""Columns of the outcome of a run."""


class Trace(NamedTuple):
    """The trace of the runs of all lanes, looked at in two ways."""

    flat: FloatArray
    """As plain floats, shape (rows, columns, lanes)."""
    numbers: FloatArray
    """As numbers, shape (rows, columns)."""
    sized: bool
    """Whether the thickness is asked for, or a probe, whose place depends on it."""


class Written(NamedTuple):
    """The output of a run."""

    trace: Trace
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
def record(trace, at, taken, now, back, rates, size):
    """Write one row of the trace in all lanes.

    ``back`` is the temperature there, ``rates`` are those of gas and heat of combustion. The length
    of a step that the next one continues is infinite where the flux has a kink.
    """
    to = trace.numbers
    to[at, TIME] = now.clock.t
    to[at, RELEASED] = now.balance.released
    to[at, RATE], to[at, POWER] = rates
    to[at, FRONT] = now.top.front
    to[at, BACK] = back
    to[at, THICKNESS] = size.depth
    to[at, BURNT] = now.balance.burnt
    to[at, KINK] = where(now.clock.dt_old == math.inf, 1.0, 0.0 * taken)
    to[at, TAKEN] = taken


@inner
def record_probes(trace, at, front, size, flat, firsts, ahead, probes):
    """Write the temperatures inside the sample in one row of the trace."""
    cell, foil = flat.cell, flat.m.shape[1]
    in_material, in_fixture = probes.material.shape[1], probes.fixture.shape[1]
    if in_material + in_fixture == 0:
        return
    for lane in range(firsts.size):
        first, T = firsts[lane], in_lane(front, lane)
        d, r = in_lane(size.d_skin, lane), in_lane(size.r_skin, lane)
        to = PROBES
        for a in range(in_material):
            place = probes.material[lane, a]
            trace.flat[at, to, lane] = of_material(
                place, ahead[lane], cell, foil, lane, first, T, r
            )
            to += 1
        for a in range(in_fixture):
            height = probes.fixture[lane, a]
            trace.flat[at, to, lane] = of_fixture(height, cell, foil, lane, first, T, d, r)
            to += 1


@loop
def compact(trace, rows):
    """Move the rows of accepted steps together, lane by lane."""
    for lane in range(trace.shape[2]):
        to = 0
        for at in range(rows):
            if trace[at, TAKEN, lane] == 1.0:
                if to < at:
                    for column in range(trace.shape[1]):
                        trace[to, column, lane] = trace[at, column, lane]
                to += 1
