"""Runs of the kernels: parameter sets side by side, and what comes of each."""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np

from pyrofit.solver import arrays
from pyrofit.solver.arrays import FloatArray, IntArray, Numerics, Status
from pyrofit.solver.curves import Request, Runs
from pyrofit.solver.lower import total
from pyrofit.solver.lower_experiment import Layer, cells_of

LANES = 8
"""Parameter sets that run side by side."""
FEW = 3
"""Sets that are faster one after the other than with empty lanes."""


class Case(NamedTuple):
    """A gasification experiment as the kernel takes it, the sets last."""

    layers: tuple[Layer, ...]
    cells: IntArray
    """Number of cells, shape (sets,)."""
    T_start: FloatArray
    properties: arrays.Material
    network: arrays.Network
    exposure: arrays.Exposure
    probes_m: tuple[float, ...]


def heat(
    programs: tuple[FloatArray, FloatArray, IntArray],
    lags: FloatArray,
    start: FloatArray,
    network: arrays.Network,
    step: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return mass fraction and rate, shape (sets, points); side by side run sets of one step."""
    from pyrofit.solver.kernels.tga import tga

    sets = start.shape[-1]
    mass = np.empty((sets, programs[0].size))
    rate = np.empty_like(mass)
    for longest_rise in np.unique(step):
        order = np.flatnonzero(step == longest_rise)
        for group in _groups((lags, start, network), order, sets):
            in_lanes = tga((0,) * group.width, *programs, *group.parts, longest_rise)
            mass[group.sets], rate[group.sets] = (c.T[: group.sets.size] for c in in_lanes)
    return mass, rate


class _Group(NamedTuple):
    """Sets that run side by side, in how many lanes, and the arrays of these lanes."""

    sets: IntArray
    width: int
    parts: Any


def _groups(parts: Any, order: IntArray, sets: int) -> list[_Group]:
    """Share out sets in the order given, of as many as the last axis of the arrays has."""
    if sets == 1:
        return [_Group(order, 1, parts)]
    rest = order.size % LANES
    size = order.size - rest if rest <= FEW else order.size
    groups = []
    if size:
        # In the lanes left over the last one runs again.
        filled = np.append(order[:size], np.repeat(order[size - 1 : size], -size % LANES))
        together = _mapped(lambda a: _split(a, filled), parts)
        for g in range(filled.size // LANES):
            index = order[:size][g * LANES : (g + 1) * LANES]
            groups.append(_Group(index, LANES, _mapped(itemgetter(g), together)))
    return groups + [_alone(parts, index) for index in order[size:, None]]


def _alone(parts: Any, index: IntArray) -> _Group:
    return _Group(index, 1, _mapped(lambda a: a.take(index, axis=-1), parts))


def _split(array: FloatArray, order: IntArray) -> FloatArray:
    """Return an array with one more axis in front, the groups; the last axis is a group's sets."""
    rows, groups = array.size // array.shape[-1], order.size // LANES
    taken = array.take(order, axis=-1).reshape(rows, groups, LANES).swapaxes(0, 1)
    return np.ascontiguousarray(taken).reshape(groups, *array.shape[:-1], LANES)


def _mapped(change: Callable[[FloatArray], FloatArray], part: Any) -> Any:
    """Return arrays of numbers changed, whatever tuples they are held in; all else as it is."""
    if isinstance(part, np.ndarray) and part.dtype == np.float64:
        return change(part)
    if isinstance(part, tuple):
        changed = [_mapped(change, p) for p in part]
        return type(part)(*changed) if hasattr(part, "_fields") else tuple(changed)
    return part


def march(case: Case, asked: Mapping[str, Request], numerics: Numerics, threads: int) -> Runs:
    """Run the kernel, sets of about the same number of cells side by side."""
    sets = case.cells.size
    runs = Runs(
        status=np.empty(sets, np.int64),
        signals={name: np.empty(request.time_s.shape) for name, request in asked.items()},
        cells=np.empty(sets, np.int64),
        steps=np.empty(sets, np.int64),
        energy_error=np.empty(sets),
        mass_error=np.empty(sets),
    )

    def fill(group: _Group) -> None:
        _march_group(case, asked, numerics, group, runs)

    ends = [r.time_s.max(axis=1) + 0.5 * r.average_s for r in asked.values()]
    groups = _groups((case, np.max(ends, axis=0)), np.argsort(case.cells, kind="stable"), sets)
    if threads > 1 and len(groups) > 1:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(fill, groups))
    else:
        for group in groups:
            fill(group)
    return runs


def _march_group(
    case: Case,
    asked: Mapping[str, Request],
    numerics: Numerics,
    group: _Group,
    runs: Runs,
) -> None:
    """Run sets side by side, and write what comes of them."""
    from pyrofit.solver.kernels.slab import slab

    index, width, (lanes, t_end) = group
    count = index.size
    cells = case.cells[index]
    if count < width:
        cells = np.append(cells, np.repeat(cells[-1:], width - count))
    start, empty = cells_of(lanes.layers, cells, LANES // width)
    trace, outcome = slab(
        (0,) * width,
        (0,) * LANES,
        start,
        empty,
        lanes.T_start,
        lanes.properties,
        lanes.network,
        lanes.exposure,
        numerics,
        t_end,
        set(asked) <= {"mlr", "mass"},
        _in_cells(case.probes_m, start, empty, lanes.properties),
    )
    outcome = outcome[:count]
    runs.status[index], runs.steps[index] = outcome[:, 0], outcome[:, 1]
    runs.energy_error[index], runs.mass_error[index] = outcome[:, 2], outcome[:, 3]
    runs.cells[index] = len(start) - empty[:count]
    last = outcome[:, 1].astype(np.int64)
    finished = outcome[:, :1] <= Status.UNBURNT
    for name, request in asked.items():
        curve = _sample(name, request, index, trace, last, lanes.layers)
        runs.signals[name][index] = curve if finished.all() else np.where(finished, curve, np.nan)


def _sample(
    name: str,
    request: Request,
    index: IntArray,
    trace: FloatArray,
    last: IntArray,
    layers: tuple[Layer, ...],
) -> FloatArray:
    """Return a signal of some sets, shape (sets, points)."""
    from pyrofit.solver.kernels import trace as columns_of
    from pyrofit.solver.kernels.output import averaged_rate, sampled, sampled_rate

    at = request.time_s[index]
    if name == "mlr":
        if request.average_s == 0.0:
            return _floats(sampled_rate(trace, last, at))
        return _floats(averaged_rate(trace, last, at, 0.5 * request.average_s))
    if name == "mass":
        initial = np.asarray(sum(total(layer.mass) for layer in layers))[: index.size, None]
        return _floats(initial - sampled(trace, last, columns_of.RELEASED, at))
    columns = {
        "front_temperature": columns_of.FRONT,
        "back_temperature": columns_of.BACK,
        "thickness": columns_of.THICKNESS,
    }
    if name.startswith("probe_"):
        columns[name] = columns_of.PROBES + int(name[6:])
    return _floats(sampled(trace, last, columns[name], at))


def _in_cells(
    depths_m: tuple[float, ...], start: FloatArray, empty: IntArray, properties: arrays.Material
) -> FloatArray:
    """Return depths in the virgin sample counted in its cells, shape (lanes, probes)."""
    out = np.empty((empty.size, len(depths_m)))
    if depths_m:
        thickness = total((start * properties.specific_volume).swapaxes(0, 1))
        for lane, ahead in enumerate(empty):
            edges = np.concatenate(([0.0], np.cumsum(thickness[ahead:, lane])))
            out[lane] = np.interp(depths_m, edges, np.arange(edges.size))
    return out


def _floats(values: object) -> FloatArray:
    return np.asarray(values, dtype=np.float64)
