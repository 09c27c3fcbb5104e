"""Fluxes as tables over common times, and numbers of a side by name."""

from collections.abc import Mapping

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.time_table import OverTime, TimeTable
from pyrofit.solver.arrays import FloatArray


def table_of(given: OverTime) -> TimeTable:
    """Return a constant as a table of one point, and a table as it is."""
    return given if isinstance(given, TimeTable) else TimeTable(time_s=(0.0,), value=(given,))


def merged(time: tuple[float, ...], knots: FloatArray) -> tuple[float, ...]:
    """Return the times and those knots that are none of them; two equal times remain a step."""
    return tuple(sorted([*time, *(t for t in knots.tolist() if t not in time)]))


def described_at(
    table: TimeTable, time: tuple[float, ...], values: Mapping[str, float]
) -> FloatArray:
    """Return the described flux at its own times and at others between them [W/m2]."""
    own = np.array([value_of(q, values) for q in table.value])
    flux = np.interp(time, table.time_s, own)
    flux[np.isin(time, table.time_s)] = own
    return np.asarray(flux)


def named_numbers(given: OverTime, name: str) -> OverTime:
    """Return a name in place of a number, or one in place of each of a table."""
    if not isinstance(given, TimeTable):
        return name
    names = tuple(f"{name}_at_{k}" for k in range(len(given.value)))
    return TimeTable(time_s=given.time_s, value=names)
