"""Runs of the kernels: parameter sets side by side, and what comes of each."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
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

    layers: list[Layer]
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
        for index, width in _lanes(np.flatnonzero(step == longest_rise)):
            parts = _take((lags, start, network), _filled(index, width))
            in_lanes = tga((0,) * width, *programs, *parts, longest_rise)
            mass[index], rate[index] = (curve.T[: index.size] for curve in in_lanes)
    return mass, rate


def _lanes(order: IntArray) -> list[tuple[IntArray, int]]:
    """Return groups of sets, and in how many lanes each runs."""
    whole = order.size - order.size % LANES
    groups = [(order[a : a + LANES], LANES) for a in range(0, whole, LANES)]
    rest = order[whole:]
    if rest.size > FEW:
        return [*groups, (rest, LANES)]
    return groups + [(rest[a : a + 1], 1) for a in range(rest.size)]


def _filled(index: IntArray, width: int) -> IntArray:
    """Return as many sets as there are lanes, the last one again in those left over."""
    return np.append(index, np.repeat(index[-1:], width - index.size))


def _take(part: Any, index: IntArray) -> Any:
    """Return some sets of arrays, whatever they are held in."""
    if isinstance(part, np.ndarray) and part.dtype == np.float64:
        if part.shape[-1] == index.size == 1:
            return part if part.flags.c_contiguous else np.ascontiguousarray(part)
        return np.take(part, index, axis=-1)
    if isinstance(part, tuple):
        taken = (_take(p, index) for p in part)
        return type(part)(*taken) if hasattr(part, "_fields") else tuple(taken)
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

    def fill(group: tuple[IntArray, int]) -> None:
        _march_group(case, asked, numerics, *group, runs)

    groups = _lanes(np.argsort(case.cells, kind="stable"))
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
    index: IntArray,
    width: int,
    runs: Runs,
) -> None:
    """Run sets side by side, and write what comes of them."""
    from pyrofit.solver.kernels.slab import slab

    filled = _filled(index, width)
    layers = [_take(layer, filled) for layer in case.layers]
    start, empty = cells_of(layers, case.cells[filled], LANES // width)
    properties, network, exposure = _take((case.properties, case.network, case.exposure), filled)
    ends = [r.time_s[filled].max(axis=1) + 0.5 * r.average_s for r in asked.values()]
    trace, outcome = slab(
        (0,) * width,
        (0,) * LANES,
        start,
        empty,
        case.T_start[filled],
        properties,
        network,
        exposure,
        numerics,
        np.max(ends, axis=0),
        set(asked) <= {"mlr", "mass"},
        _in_cells(case.probes_m, start, empty, properties),
    )
    count = index.size
    outcome = outcome[:count]
    runs.status[index], runs.steps[index] = outcome[:, 0], outcome[:, 1]
    runs.energy_error[index], runs.mass_error[index] = outcome[:, 2], outcome[:, 3]
    runs.cells[index] = len(start) - empty[:count]
    initial = np.asarray(sum(total(layer.mass) for layer in layers))[:count]
    finished = outcome[:, :1] <= Status.UNBURNT
    for name, request in asked.items():
        curve = _sample(name, request, index, trace, outcome[:, 1].astype(np.int64), initial)
        runs.signals[name][index] = np.where(finished, curve, np.nan)


def _sample(
    name: str,
    request: Request,
    index: IntArray,
    trace: FloatArray,
    last: IntArray,
    initial: FloatArray,
) -> FloatArray:
    """Return a signal of some sets, shape (sets, points)."""
    from pyrofit.solver.kernels import trace as columns_of
    from pyrofit.solver.kernels.output import sampled, sampled_rate

    at = request.time_s[index]
    if name == "mlr":
        half = 0.5 * request.average_s
        if half == 0.0:
            return _floats(sampled_rate(trace, last, at))
        begin = np.maximum(at - half, 0.0)
        gained = sampled(trace, last, columns_of.RELEASED, at + half)
        gained -= sampled(trace, last, columns_of.RELEASED, begin)
        return _floats(gained / np.maximum(at + half - begin, 1e-9))
    if name == "mass":
        return _floats(initial[:, None] - sampled(trace, last, columns_of.RELEASED, at))
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
