"""Runs of the kernels: parameter sets side by side, and their results."""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache, reduce
from typing import Any, NamedTuple

import numpy as np

from pyrofit.solver import arrays
from pyrofit.solver.arrays import FloatArray, IntArray, Numerics, Status
from pyrofit.solver.curves import Request, Runs
from pyrofit.solver.lower_experiment import LoweredLayer, share_out_cells
from pyrofit.solver.lower_property import total
from pyrofit.solver.outputs import BACK, FRONT, HEAT, INSIDE, MASS, RATE, THICKNESS
from pyrofit.solver.probes import depths_of, follows_of, probes_of

LANES = 8
"""Parameter sets that run side by side."""
FEW = 3
"""Sets that are faster one after the other than with empty lanes."""
FILLED = 0.6
"""Sets that are faster so, too, if their cells are on the average less than this share of the most:
lanes of few cells wait for that of most."""
UNBURNT = int(Status.UNBURNT)
EARLY = {RATE, HEAT, MASS}
"""Signals that do not change any more once the reactant is gone."""


class Case(NamedTuple):
    """A gasification experiment as the kernel takes it, the sets last."""

    layers: tuple[LoweredLayer, ...]
    cells: IntArray
    """Number of cells, shape (sets,)."""
    T_start: FloatArray
    description: arrays.Description

    @property
    def volumes(self) -> FloatArray:
        """Specific volumes of the components [m3/kg], shape (components, sets)."""
        return self.description.material.specific_volume


def split(array: FloatArray, order: IntArray) -> FloatArray:
    """Return an array with one more axis in front, the groups; the last axis is a group's sets."""
    rows, groups = array.size // array.shape[-1], order.size // LANES
    taken = array.take(order, axis=-1).reshape(rows, groups, LANES).swapaxes(0, 1)
    return np.ascontiguousarray(taken).reshape(groups, *array.shape[:-1], LANES)


def mapped(change: Callable[[FloatArray], FloatArray], part: Any) -> Any:
    """Return arrays of numbers changed, whatever tuples they are held in; all else as it is."""
    if isinstance(part, np.ndarray) and part.dtype == np.float64:
        return change(part)
    if isinstance(part, tuple):
        changed = [mapped(change, p) for p in part]
        return type(part)(*changed) if hasattr(part, "_fields") else tuple(changed)
    return part


def repeated_case(case: Case, copies: int) -> Case:
    """Return a case of several copies of its sets, one after the other."""
    if copies == 1:
        return case
    index = np.tile(np.arange(case.cells.size), copies)
    many: Case = mapped(lambda a: a.take(index, axis=-1), case)
    return many._replace(cells=case.cells[index])


def run_kernel(
    case: Case, asked: Mapping[str, Request], numerics: Numerics, threads: int, led: int = 0
) -> Runs:
    """Run the kernel, sets of about the same number of cells side by side.

    Where ``led`` is not zero, the first of so many sets leads: the others take its cells and time
    steps.
    """
    if led:
        case, numerics = _led(case, led), numerics._replace(led=True)
    work = _work_of(case, asked, numerics)
    sets = case.cells.size
    if sets == 1:
        return _runs(work, asked, *_alone(work))
    signals = np.empty((sets, work.at.shape[1]))
    outcome, cells = np.empty((sets, 4)), np.empty(sets, np.int64)

    def fill(index: IntArray) -> None:
        found = _alone(work, index) if index.size == 1 else _together(work, index)
        signals[index], outcome[index], cells[index] = found

    parts = _led_parts(sets, led, threads) if led else _parts(case.cells, threads)
    if threads > 1 and len(parts) > 1:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(fill, parts))
    else:
        for index in parts:
            fill(index)
    return _runs(work, asked, signals, outcome, cells)


class _Work(NamedTuple):
    """The inputs of the kernel, of all sets.

    ``at`` are the times asked for, shape (sets, points), ``depths`` those of the probes in the
    virgin sample [m], shape (sets, probes).
    """

    case: Case
    numerics: Numerics
    end: arrays.End
    asked: arrays.Asked
    at: FloatArray
    depths: arrays.Probes
    outputs: list[str]


def _work_of(case: Case, asked: Mapping[str, Request], numerics: Numerics) -> _Work:
    """Return the inputs of the kernel for requests whose times have the shape (sets, points)."""
    requests = list(asked.values())
    outputs = [r.of(n) for n, r in asked.items()]
    signals = tuple(
        (output, follows_of(r), r.average_s, r.time_s.shape[1])
        for output, r in zip(outputs, requests, strict=True)
    )
    ends = [r.end_s for r in requests]
    at = requests[0].time_s if len(requests) == 1 else np.hstack([r.time_s for r in requests])
    if HEAT in outputs:
        network = case.description.network._replace(burns=True)
        case = case._replace(description=case.description._replace(network=network))
    return _Work(
        case,
        numerics,
        arrays.End(reduce(np.maximum, ends), EARLY.issuperset(outputs)),
        _asked(signals),
        np.ascontiguousarray(at),
        arrays.Probes(*(depths_of(asked, to, case.cells.size) for to in arrays.Probes._fields)),
        outputs,
    )


@cache
def _asked(signals: tuple[tuple[str, str, float, int], ...]) -> arrays.Asked:
    """Return signals as the kernel takes them, from names, `follows`, bin widths [s], points."""
    from pyrofit.solver.kernels import trace

    columns = {
        RATE: trace.RATE,
        HEAT: trace.POWER,
        MASS: trace.RELEASED,
        FRONT: trace.FRONT,
        BACK: trace.BACK,
        THICKNESS: trace.THICKNESS,
    }
    names, follow, widths, points = zip(*signals, strict=True)
    order = [k for to in arrays.Probes._fields for k, follows in enumerate(follow) if follows == to]
    column = [
        trace.PROBES + order.index(k) if name == INSIDE else columns[name]
        for k, name in enumerate(names)
    ]
    return arrays.Asked(np.array(column), 0.5 * np.array(widths), np.cumsum([0, *points]))


def _parts(cells: IntArray, threads: int) -> list[IntArray]:
    """Share out sets, by cells: groups to as many calls as there are threads, others alone."""
    order = np.argsort(cells, kind="stable")
    first = np.arange(0, order.size, LANES)
    sizes = np.diff(first, append=order.size)
    most = cells[order[first + sizes - 1]]
    mean = np.add.reduceat(cells[order], first) / sizes
    grouped = np.repeat((sizes > FEW) & (mean >= FILLED * most), sizes)
    together, alone = order[grouped], order[~grouped]
    share = LANES * -(-together.size // (LANES * threads))
    parts = [together[i : i + share] for i in range(0, together.size, share or 1)]
    return parts + list(alone[:, None])


def _led(case: Case, led: int) -> Case:
    """Return a case whose sets have the cells of the first of every ``led`` sets."""
    leader = np.arange(case.cells.size) // led * led

    def of_leader(cells: FloatArray | None) -> FloatArray | None:
        return None if cells is None else cells[leader]

    layers = tuple(layer._replace(cells=of_leader(layer.cells)) for layer in case.layers)
    exposure = case.description.exposure
    exposure = exposure._replace(backing_cells=exposure.backing_cells[leader])
    description = case.description._replace(exposure=exposure)
    return Case(layers, case.cells[leader], case.T_start, description)


def _led_parts(sets: int, led: int, threads: int) -> list[IntArray]:
    """Share out sets: groups of a leader and others that it leads, to as many calls as threads."""
    groups = []
    for leader in range(0, sets, led):
        others = np.arange(leader + 1, leader + led)
        for i in range(0, others.size, LANES - 1):
            group = np.append(leader, others[i : i + LANES - 1])
            groups.append(np.append(group, np.repeat(group[-1:], LANES - group.size)))
    share = -(-len(groups) // threads)
    return [np.concatenate(groups[i : i + share]) for i in range(0, len(groups), share)]


Found = tuple[FloatArray, FloatArray, IntArray]
"""Signals, shape (sets, points), outcomes, and numbers of cells."""


def _alone(work: _Work, index: IntArray | None = None) -> Found:
    """Run one set of several, or the only one."""
    from pyrofit.solver.kernels.slab import slab

    case, end, at, cells = work.case, work.end, work.at, work.case.cells
    depths = work.depths
    if index is not None:
        case, end = mapped(lambda a: a.take(index, axis=-1), (case, end))
        at, cells = at[index], cells[index]
        depths = arrays.Probes(*(depth[index] for depth in depths))
    start, empty = share_out_cells(case.layers, cells, LANES)
    signals, outcome = slab(
        (0,),
        (0,) * LANES,
        arrays.Start(start, empty, case.T_start),
        case.description,
        work.numerics,
        end,
        probes_of(depths, start, empty, case.volumes),
        work.asked,
        at,
    )
    return signals, outcome, len(start) - empty


def _together(work: _Work, index: IntArray) -> Found:
    """Run sets side by side; in the lanes left over the last one runs again."""
    from pyrofit.solver.kernels.slab import slabs

    case = work.case
    filled = np.append(index, np.repeat(index[-1:], -index.size % LANES))
    layers, volumes = mapped(lambda a: a.take(filled, axis=-1), (case.layers, case.volumes))
    start, empty = share_out_cells(layers, case.cells[filled])
    depths = arrays.Probes(*(depth[filled] for depth in work.depths))
    probes = probes_of(depths, start, empty, volumes)
    T_start, description, end = mapped(
        lambda a: split(a, filled), (case.T_start, case.description, work.end)
    )
    per_lane = (filled.size // LANES, LANES)
    signals, outcome = slabs(
        (0,) * LANES,
        arrays.Start(split(start, np.arange(filled.size)), empty.reshape(per_lane), T_start),
        description,
        work.numerics,
        end,
        arrays.Probes(*(places.reshape(*per_lane, places.shape[1]) for places in probes)),
        work.asked,
        work.at[filled].reshape(*per_lane, work.at.shape[1]),
    )
    count = index.size
    flat = (a.reshape(filled.size, -1)[:count] for a in (signals, outcome))
    return (*flat, (len(start) - empty)[:count])


def _runs(
    work: _Work,
    asked: Mapping[str, Request],
    signals: FloatArray,
    outcome: FloatArray,
    cells: IntArray,
) -> Runs:
    """Return the results of all sets."""
    status = outcome[:, 0].astype(np.int64)
    failed = status > UNBURNT
    if np.count_nonzero(failed):
        signals[failed] = np.nan
    begin = work.asked.begin.tolist()
    curves = {
        name: signals[:, begin[k] : begin[k + 1]]
        if work.outputs[k] != MASS
        else _initial_mass(work.case)[:, None] - signals[:, begin[k] : begin[k + 1]]
        for k, name in enumerate(asked)
    }
    return Runs(
        status=status,
        signals=curves,
        cells=cells,
        steps=outcome[:, 1].astype(np.int64),
        energy_error=outcome[:, 2],
        mass_error=outcome[:, 3],
    )


def _initial_mass(case: Case) -> FloatArray:
    """Return the mass per area of the samples [kg/m2], shape (sets,)."""
    sample = (layer for layer in case.layers if layer.cells is None)
    return np.asarray(sum(total(layer.mass) for layer in sample))
