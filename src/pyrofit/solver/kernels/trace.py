"""What is kept of every step: a row for each, lane by lane."""

import math

from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.jit import inner
from pyrofit.solver.kernels.lanes import in_lane

TIME, RELEASED, RATE, FRONT, BACK, THICKNESS, BURNT, POWER, KINK, PROBES = range(10)
"""Columns of the trace; any number of probes."""
STATUS, STEPS, ENERGY_ERROR, MASS_ERROR = range(4)
"""Columns of what a run came to."""


@inner
def probe_temperature(position, ahead, cell, foil, lane, first, front):
    """Return T at a Lagrangian position, linear between centres.

    It is counted in cells from the front of the virgin sample, ``ahead`` of which are empty ones.
    """
    below = math.floor(position - 0.5)
    part = position - 0.5 - below
    low = below + ahead
    gone = first - ahead
    if position <= gone:
        return front
    if low < first:
        return front + (cell[row.T, first, lane] - front) * (position - gone) / 0.5
    if low >= foil - 1:
        half, contact = cell[row.half_r, foil - 1, lane], cell[row.half_r, foil, lane]
        part = (position - (foil - ahead) + 0.5) / 0.5 * (half / (half + contact))
        low = foil - 1
    here = cell[row.T, low, lane]
    return here + part * (cell[row.T, low + 1, lane] - here)


@inner
def record(trace, lane, numbers, flat, first, ahead, probes):
    """Write one row of the trace of a lane.

    The numbers: time, mass released, rate, front T, thickness, heat of combustion, that per time,
    and the length of the step that the next one continues, infinite where the flux has a kink.
    """
    t, released, rate, front, depth, burnt, power, before = numbers
    foil = flat.m.shape[1]
    trace[TIME] = in_lane(t, lane)
    trace[RELEASED] = in_lane(released, lane)
    trace[RATE] = in_lane(rate, lane)
    trace[FRONT] = in_lane(front, lane)
    trace[BACK] = flat.cell[row.T, foil, lane]
    trace[THICKNESS] = in_lane(depth, lane)
    trace[BURNT] = in_lane(burnt, lane)
    trace[POWER] = in_lane(power, lane)
    trace[KINK] = 1.0 if in_lane(before, lane) == math.inf else 0.0
    for a in range(probes.shape[1]):
        trace[PROBES + a] = probe_temperature(
            probes[lane, a], ahead[lane], flat.cell, foil, lane, first, in_lane(front, lane)
        )
