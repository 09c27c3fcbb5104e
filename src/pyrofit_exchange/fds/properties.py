"""Properties of temperature as a constant or as a ramp in degrees Celsius."""

from collections.abc import Callable

import numpy as np

from pyrofit.model.properties import Property
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.solver.arrays import TABLE_TEMPERATURES_K, FloatArray, Values
from pyrofit.solver.lower_property import property_table
from pyrofit_exchange.fds.namelists import Item, Namelist

NEGLIGIBLE = 1e-6
"""Relative difference of a straight line to points that it may replace."""

Change = Callable[[FloatArray, FloatArray], FloatArray]
"""From temperatures [K] and values to changed values."""


def tabulated(prop: Property, values: Values, change: Change | None = None) -> FloatArray:
    """Return a property at the nodes of the solver's tables, one node where it is constant."""
    table = property_table(prop, values)[:, 0]
    if change is None:
        return table
    nodes = TABLE_TEMPERATURES_K
    return change(nodes, np.broadcast_to(table, nodes.shape))


def needed(T: FloatArray, p: FloatArray) -> list[int]:
    """Return the positions of the points that straight lines between them need.

    >>> needed(np.array([0.0, 1.0, 2.0, 3.0]), np.array([1.0, 2.0, 3.0, 3.0]))
    [0, 2, 3]
    """
    kept, last = [0], len(T) - 1
    while kept[-1] < last:
        begin = end = kept[-1]
        step = last - begin
        while step:  # the farthest end of a line, by halving
            trial = min(end + step, last)
            if trial > end and _straight(T, p, begin, trial):
                end = trial
            else:
                step //= 2
        kept.append(max(end, begin + 1))
    return kept


def _straight(T: FloatArray, p: FloatArray, begin: int, end: int) -> bool:
    part = slice(begin, end + 1)
    line = np.interp(T[part], T[[begin, end]], p[[begin, end]])
    return bool(np.all(np.abs(line - p[part]) <= NEGLIGIBLE * np.abs(p[part])))


def written(
    key: str, ramp: str, table: FloatArray, factor: float
) -> tuple[dict[str, Item], list[Namelist]]:
    """Return the key of a MATL line that gives a property, and the lines of its ramp.

    Parameters
    ----------
    key
        CONDUCTIVITY or SPECIFIC_HEAT.
    ramp
        Identifier of the ramp.
    table
        Values [SI] at the nodes of the solver's tables, or one.
    factor
        From SI to the unit of FDS.
    """
    scaled = factor * table
    if np.ptp(scaled) <= NEGLIGIBLE * abs(float(scaled[0])):
        return {key: float(scaled[0])}, []
    T = TABLE_TEMPERATURES_K
    lines = [
        Namelist(
            "RAMP", {"ID": ramp, "T": round(float(T[n]) - ICE_POINT_K, 6), "F": float(scaled[n])}
        )
        for n in needed(T, scaled)
    ]
    return {f"{key}_RAMP": ramp}, lines
