"""Curves of an experiment for given parameter values, for one set of them or for many at once."""

import itertools
import math
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple, Self

import numpy as np
from pydantic import Field

from pyrofit.model.base import Part, value_of
from pyrofit.model.experiment import Gasification, Tga
from pyrofit.model.material import Material
from pyrofit.solver import arrays
from pyrofit.solver.arrays import FloatArray, IntArray, Numerics, Status
from pyrofit.solver.curves import Curves, Request, Runs
from pyrofit.solver.lower import (
    Values,
    fractions,
    is_separate,
    lower_material,
    lower_network,
    total,
)
from pyrofit.solver.lower_experiment import (
    Layer,
    cells_of,
    lower_exposure,
    lower_layers,
    lower_share,
)
from pyrofit.solver.observe import observe

LANES = 8
"""Parameter sets that run side by side."""
FEW = 3
"""Sets that are faster one after the other than with empty lanes."""
COUPLED_STEP = 0.125
"""Temperature step over that of separate reactions, where one feeds or starves another."""


class Accuracy(Part):
    """How finely the slab and TGA equations are solved."""

    cells: int | None = Field(
        None, ge=2, le=5000, description="cells of the slab; none = as the reaction zone needs"
    )
    cells_factor: float = Field(
        1.0, ge=0.1, le=100.0, description="multiplies the cells that the reaction zone needs"
    )
    tolerance: float = Field(
        2e-3, gt=0.0, le=0.1, description="bound on the scaled predictor-corrector difference"
    )
    first_step_s: float = Field(0.01, gt=0.0, description="first time step [s]")
    longest_step_s: float = Field(10.0, gt=0.0, description="longest time step [s]")
    most_steps: int = Field(20000, ge=100, description="steps after which a run is given up")
    tga_step_K: float = Field(1.0, gt=0.0, description="largest temperature rise of a TGA step [K]")

    @property
    def numerics(self) -> Numerics:
        """The same for the kernel."""
        return Numerics(self.tolerance, self.first_step_s, self.longest_step_s, self.most_steps)

    def refined(self) -> Self:
        """Return settings with twice the cells and half the steps: a quarter of the error."""
        return self.model_copy(
            update={
                "cells": None if self.cells is None else 2 * self.cells,
                "cells_factor": 2.0 * self.cells_factor,
                "tolerance": 0.25 * self.tolerance,
                "first_step_s": 0.5 * self.first_step_s,
                "longest_step_s": 0.5 * self.longest_step_s,
                "most_steps": 4 * self.most_steps,
                "tga_step_K": 0.5 * self.tga_step_K,
            }
        )


def simulate_tga(
    experiment: Tga,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    accuracy: Accuracy | None = None,
) -> Curves:
    """Simulate a TGA experiment.

    Parameters
    ----------
    experiment, material
        The description.
    values
        Parameter values in SI units by name.
    request
        Times [s] and temperatures [K], shape (points,), increasing times.
    accuracy
        Numerical settings.

    Returns
    -------
    Curves
        Signals ``mass_fraction`` [-] and ``mass_loss_rate`` [1/s] at the times.
    """
    return simulate_tgas([experiment], material, values, [request], accuracy)[0][0]


def simulate_tgas(
    experiments: Sequence[Tga],
    material: Material,
    values: Values,
    requests: Sequence[Request],
    accuracy: Accuracy | None = None,
    sets: int = 1,
) -> list[list[Curves]]:
    """Simulate TGA experiments for many parameter sets, all in one call of the solver.

    As `simulate_tga`, with a request for each experiment; each value is a number or has the shape
    (sets,). The curves are listed by experiment, then by set.
    """
    accuracy = accuracy or Accuracy()
    if any(request.temperature_K is None for request in requests):
        raise ValueError("a TGA request needs temperatures")
    network = lower_network(material, values, sets, heats=False)
    start = fractions(material.composition, list(material.components), values, sets)
    lags = [
        np.full(sets, value_of(e.lag_s, values)) * e.heating_rate_K_min / 60.0 for e in experiments
    ]
    step = accuracy.tga_step_K * np.where(is_separate(network), 1.0, COUPLED_STEP)
    begins = np.cumsum([0, *(request.time_s.size for request in requests)])
    programs = (
        np.concatenate([request.time_s for request in requests]),
        np.concatenate([_given(request.temperature_K) for request in requests]),
        begins,
    )
    mass, rate = _heat(programs, np.array(lags), start, network, step)
    return [
        [_tga_curves(mass[s, a:b], rate[s, a:b]) for s in range(sets)]
        for a, b in itertools.pairwise(begins)
    ]


def _heat(
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


def _tga_curves(mass: FloatArray, rate: FloatArray) -> Curves:
    status = Status.OK if bool(np.isfinite(mass[-1])) else Status.NON_FINITE
    return Curves(status, {"mass_fraction": mass, "mass_loss_rate": rate})


def simulate_gasification(
    experiment: Gasification,
    material: Material,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    accuracy: Accuracy | None = None,
    probes_m: tuple[float, ...] = (),
) -> Curves:
    """Simulate a gasification experiment.

    Parameters
    ----------
    experiment, material
        The description.
    values
        Parameter values in SI units by name.
    requests
        By signal: ``mlr`` [kg/(m2 s)], averaged over the bin width; ``mass`` [kg/m2],
        ``back_temperature``, ``front_temperature`` [K], ``thickness`` [m], and
        ``probe_0`` ... [K] for the probes.
    accuracy
        Numerical settings.
    probes_m
        Depths of temperature probes in the virgin sample [m].

    Returns
    -------
    Curves
        The signals at their times, empty unless the run finished. MLR over a bin is the
        difference of the released mass, so that mass closes to round-off.
    """
    return simulate_gasifications(experiment, material, values, requests, accuracy, probes_m)[0]


def simulate_gasifications(
    experiment: Gasification,
    material: Material,
    values: Values,
    requests: Mapping[str, Request],
    accuracy: Accuracy | None = None,
    probes_m: tuple[float, ...] = (),
    sets: int = 1,
    threads: int = 1,
) -> list[Curves]:
    """Simulate a gasification experiment for many parameter sets.

    As `simulate_gasification`; each value is a number or has the shape (sets,). A set has the same
    curves to the last bit alone and among others, with one thread and with several.
    """
    accuracy = accuracy or Accuracy()
    case = _lower(experiment, material, values, accuracy, probes_m, sets)

    def run(factor: FloatArray, asked: Mapping[str, Request]) -> Runs:
        exposed = case.exposure._replace(flux=factor * case.exposure.flux)
        return _march(case._replace(exposure=exposed), asked, accuracy.numerics, threads)

    return observe(experiment, values, requests, run, sets).curves()


class _Case(NamedTuple):
    """A gasification experiment as the kernel takes it, the sets last."""

    layers: list[Layer]
    cells: IntArray
    """Number of cells, shape (sets,)."""
    T_start: FloatArray
    properties: arrays.Material
    network: arrays.Network
    exposure: arrays.Exposure
    probes_m: tuple[float, ...]


def _lower(
    experiment: Gasification,
    material: Material,
    values: Values,
    accuracy: Accuracy,
    probes_m: tuple[float, ...],
    sets: int,
) -> _Case:
    length = value_of(experiment.sample.absorption_length_m, values)
    properties = lower_material(material, values, sets, length)
    network = lower_network(material, values, sets)
    exposure = lower_exposure(experiment, material, properties, values, sets)
    layers = lower_layers(experiment, material, properties, values, sets)
    T_start = np.full(sets, value_of(experiment.sample.initial_temperature_K, values))
    cells = np.full(sets, accuracy.cells or 0)
    if accuracy.cells is None:
        from pyrofit.solver.kernels.grid import cells_needed

        share = lower_share(experiment, material, values, sets)
        thickness = np.asarray(sum(layer.thickness for layer in layers))
        needed = cells_needed(share, thickness, T_start, properties, network, exposure)
        cells = np.ceil(accuracy.cells_factor * needed).astype(np.int64)
    return _Case(layers, cells, T_start, properties, network, exposure, probes_m)


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


def _march(case: _Case, asked: Mapping[str, Request], numerics: Numerics, threads: int) -> Runs:
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
    case: _Case,
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


def solver_errors(
    experiment: Gasification,
    material: Material,
    values: Mapping[str, float],
    requests: Mapping[str, Request],
    accuracy: Accuracy | None = None,
) -> dict[str, float]:
    """Estimate the solver's own error of a run, by running it again more finely.

    With twice the cells and half the steps both errors, of second order, are a quarter; so the
    error is 4/3 of the difference (Richardson).

    Returns
    -------
    dict
        Root mean square of the error by signal, in its SI unit; NaN where a run did not finish.
    """
    accuracy = accuracy or Accuracy()
    coarse = simulate_gasification(experiment, material, values, requests, accuracy)
    fine = simulate_gasification(experiment, material, values, requests, accuracy.refined())
    return errors_between(coarse, fine, requests)


def errors_between(
    coarse: Curves, fine: Curves, requests: Mapping[str, Request]
) -> dict[str, float]:
    """Return the same of two runs that are at hand, the second with `Accuracy.refined`."""
    if not (coarse.status.finished and fine.status.finished):
        return dict.fromkeys(requests, math.nan)
    return {
        name: 4.0 / 3.0 * float(np.sqrt(np.mean((coarse.signals[name] - curve) ** 2)))
        for name, curve in fine.signals.items()
    }


def _sample(
    name: str,
    request: Request,
    index: IntArray,
    trace: FloatArray,
    last: IntArray,
    initial: FloatArray,
) -> FloatArray:
    """Return a signal of some sets, shape (sets, points)."""
    from pyrofit.solver.kernels import slab
    from pyrofit.solver.kernels.output import sampled, sampled_rate

    at = request.time_s[index]
    if name == "mlr":
        half = 0.5 * request.average_s
        if half == 0.0:
            return _floats(sampled_rate(trace, last, at))
        begin = np.maximum(at - half, 0.0)
        gained = sampled(trace, last, slab.RELEASED, at + half)
        gained -= sampled(trace, last, slab.RELEASED, begin)
        return _floats(gained / np.maximum(at + half - begin, 1e-9))
    if name == "mass":
        return _floats(initial[:, None] - sampled(trace, last, slab.RELEASED, at))
    columns = {
        "front_temperature": slab.FRONT,
        "back_temperature": slab.BACK,
        "thickness": slab.THICKNESS,
    }
    if name.startswith("probe_"):
        columns[name] = slab.PROBES + int(name[6:])
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


def _given(temperature: FloatArray | None) -> FloatArray:
    assert temperature is not None
    return temperature


def _floats(values: object) -> FloatArray:
    return np.asarray(values, dtype=np.float64)
