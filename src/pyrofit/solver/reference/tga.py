"""Thermogravimetric analysis by the reference solver."""

from collections.abc import Iterator, Mapping

import numpy as np
from scipy.integrate import LSODA

from pyrofit.model.accuracy import Resolution
from pyrofit.model.base import value_of
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.solver.arrays import FloatArray, Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.outputs import FRACTION_RATE, MASS_FRACTION
from pyrofit.solver.reference.substance import Reactions, mass_fractions, substance

STRAIGHT_K = 1e-9
"""Deviation from a line up to which temperatures belong to one heating rate [K]."""


def reference_tga(
    experiment: HeatedExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    resolution: Resolution | None = None,
) -> Curves:
    """Simulate a TGA experiment, as `pyrofit.simulate.simulate_tga` does.

    Arguments and result are the same; ``resolution`` holds the numerical settings.
    """
    resolution = resolution or Resolution()
    if request.temperature_K is None:
        raise ValueError("a TGA request needs temperatures")
    lag_min = value_of(experiment.lag_s, values) / 60.0
    time, T = request.time_s, request.temperature_K - lag_min * experiment.heating_rate_K_min
    solid = substance(material, values)
    virgin = mass_fractions(material.composition, solid.names, values)
    extent = np.zeros((time.size, solid.reactions.A.size))
    steps = 0
    for first, last in straight(time, T):
        part = slice(first, last + 1)
        found = _heat(
            solid.reactions, virgin, extent[first], time[part], T[part], resolution.tga_tolerance
        )
        if found is None:
            return Curves(Status.NON_FINITE, {}, steps=steps)
        extent[part] = found[0]
        steps += found[1]
    rate = solid.reactions.rate_constants(T) * solid.reactions.amounts(virgin, extent)
    lost = extent @ solid.reactions.gas
    signals = {MASS_FRACTION: 1.0 - lost, FRACTION_RATE: rate @ solid.reactions.gas}
    return Curves(Status.OK, signals, steps=steps)


def straight(time: FloatArray, T: FloatArray) -> Iterator[tuple[int, int]]:
    """Yield first and last point of each part of the program that has one heating rate."""
    first = 0
    while first < time.size - 1:
        rate = (T[first + 1] - T[first]) / (time[first + 1] - time[first])
        off = np.abs(T[first:] - T[first] - rate * (time[first:] - time[first])) > STRAIGHT_K
        last = first + int(off.argmax()) - 1 if off.any() else time.size - 1
        last = max(last, first + 1)
        yield first, last
        first = last


def _heat(
    reactions: Reactions,
    virgin: FloatArray,
    start: FloatArray,
    time: FloatArray,
    T: FloatArray,
    tolerance: float,
) -> tuple[FloatArray, int] | None:
    """Return the extents at the times of a straight part and the steps taken, None if it failed."""
    rate = (T[-1] - T[0]) / (time[-1] - time[0])

    def derivative(t: float, extent: FloatArray) -> FloatArray:
        k = reactions.rate_constants(T[0] + rate * (t - time[0]))
        return np.asarray(k * reactions.amounts(virgin, extent))

    solver = LSODA(derivative, time[0], start, time[-1], rtol=tolerance, atol=tolerance)
    extent = np.empty((time.size, start.size))
    extent[0] = start
    filled, steps = 1, 0
    while solver.status == "running":
        solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            return None
        steps += 1
        to = int(np.searchsorted(time, solver.t, side="right"))
        if to > filled:
            extent[filled:to] = solver.dense_output()(time[filled:to]).T
            filled = to
    return extent, steps
