"""The quantities that a description gives over time as one table, at all their times."""

from collections.abc import Sequence

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.model.slab_faces import Flame, Side
from pyrofit.model.time_table import OverTime, TimeTable
from pyrofit.solver.arrays import (
    BACK_H,
    FLAME,
    FLUX,
    FRONT_H,
    LIT,
    OXYGEN,
    TIME,
    FloatArray,
    Value,
    Values,
)
from pyrofit.solver.lower_property import stack

Point = tuple[float, bool]
"""A time [s], and whether the value just before it is meant."""


def lower_schedule(experiment: SlabExperiment, values: Values, sets: int) -> FloatArray:
    """Return flux, h and temperatures over time, shape (rows, points, sets).

    The points are the times of all tables; where one of them jumps, the time stands twice. The rows
    are those of `pyrofit.solver.arrays`, `TIME` first.
    """
    front, back = experiment.front, experiment.back
    losses = value_of(back.loss_factor, values)
    rows = [front.flux_W_m2, *_temperatures_and_h(front), *_temperatures_and_h(back)]
    points = _points([row for row in rows if isinstance(row, TimeTable)])
    of_rows = [value for row in rows for value in _row(row, points, values)]
    last = [value for value in (0.0, 1.0, value_of(experiment.oxygen, values)) for _ in points]
    every = stack([*(t for t, _ in points), *of_rows, *last], sets)
    schedule = every.reshape(-1, len(points), sets)
    schedule[FLUX] *= value_of(front.flux_factor, values)
    for row, side in ((FRONT_H, front), (BACK_H, back)):
        changed = schedule[row] + value_of(side.h_change_W_m2K, values)
        schedule[row] = np.maximum(changed, 0.0)
    schedule[BACK_H] *= losses
    flame = experiment.burning()
    return schedule if flame is None else _with_flame(schedule, flame, values)


def _with_flame(schedule: FloatArray, flame: Flame, values: Values) -> FloatArray:
    """Return the schedule with two points at ignition and at flame-out, and the flame's rows."""
    ends = [] if flame.ends_s is None else [flame.ends_s]
    changes = [value_of(t, values) for t in (flame.ignition_s, *ends)]
    # A flame that would end before it begins does not burn.
    changed = np.maximum.accumulate(stack(changes, schedule.shape[-1]))
    times = np.repeat(changed, 2, axis=0)
    added = np.zeros((schedule.shape[0], *times.shape))
    added[TIME] = times
    for row in range(FLUX, FLAME):
        of = zip(times.T, schedule[TIME].T, schedule[row].T, strict=True)
        added[row] = np.transpose([np.interp(*one) for one in of])
    turns = np.zeros((schedule.shape[1] + times.shape[0], schedule.shape[2]))
    for n, turn in enumerate((1.0, -1.0)[: len(changes)]):
        turns[schedule.shape[1] + 2 * n + 1] = turn
    both = np.concatenate((schedule, added), axis=1)
    order = np.argsort(both[TIME], axis=0, kind="stable")
    both = np.take_along_axis(both, order[None], axis=1)
    both[LIT] = np.cumsum(np.take_along_axis(turns, order, axis=0), axis=0)
    both[FLAME] = both[LIT] * value_of(flame.flux_W_m2, values)
    # ASSUME: while gas burns, the flame leaves no oxygen to the surface.
    both[OXYGEN] = schedule[OXYGEN, :1] * (1.0 - both[LIT])
    return both


def _temperatures_and_h(side: Side) -> tuple[OverTime, OverTime, OverTime]:
    return side.h_W_m2K, side.gas_temperature_K, side.wall_temperature_K


def _points(tables: Sequence[TimeTable]) -> list[Point]:
    """Return the times of all tables, those at which one jumps before and after the jump."""
    times = sorted({t for table in tables for t in table.time_s} | {0.0})
    steps = {t for table in tables for t in table.time_s if table.time_s.count(t) > 1}
    return [(t, before) for t in times for before in ((True, False) if t in steps else (False,))]


def _row(given: OverTime, points: Sequence[Point], values: Values) -> list[Value]:
    """Return a quantity at the points."""
    if not isinstance(given, TimeTable):
        return [value_of(given, values)] * len(points)
    own = [value_of(value, values) for value in given.value]
    return [_at(point, given.time_s, own) for point in points]


def _at(point: Point, times: Sequence[float], own: Sequence[Value]) -> Value:
    """Return the value of a table at a point: linear between two of its own, constant behind."""
    t, before = point
    if before:
        after = int(np.searchsorted(times, t, side="left"))
    else:
        after = int(np.searchsorted(times, t, side="right")) - 1
        after += times[after] < t
    if after == len(times):
        return own[-1]
    if times[after] == t:
        return own[after]
    part = (t - times[after - 1]) / (times[after] - times[after - 1])
    return own[after - 1] + (own[after] - own[after - 1]) * part
