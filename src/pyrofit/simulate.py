"""Curves of an experiment for given parameter values."""

import math
from collections.abc import Mapping
from typing import NamedTuple, Self

import numpy as np
from pydantic import Field

from pyrofit.model.base import Part, value_of
from pyrofit.model.experiment import Gasification, Tga
from pyrofit.model.material import Material
from pyrofit.solver import arrays
from pyrofit.solver.arrays import FloatArray, Numerics, Status
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.grid import cells_needed
from pyrofit.solver.lower import fractions, is_separate, lower_material, lower_network
from pyrofit.solver.lower_experiment import lower_cells, lower_exposure, lower_virgin
from pyrofit.solver.observe import observe

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
    from pyrofit.solver.kernels.tga import tga

    accuracy = accuracy or Accuracy()
    if request.temperature_K is None:
        raise ValueError("a TGA request needs temperatures")
    network = lower_network(material, values, heats=False)
    start = fractions(material.composition, list(material.components), values)
    lag = value_of(experiment.lag_s, values) * experiment.heating_rate_K_min / 60.0
    temperature = request.temperature_K - lag
    step = accuracy.tga_step_K * (1.0 if is_separate(network) else COUPLED_STEP)
    mass, rate = tga(request.time_s, temperature, start, network, step)
    ok = bool(np.isfinite(mass[-1]))
    status = Status.OK if ok else Status.NON_FINITE
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
    accuracy = accuracy or Accuracy()
    case = _lower(experiment, material, values, accuracy, probes_m)

    def run(factor: float, asked: Mapping[str, Request]) -> Curves:
        return _march(case, factor, asked, accuracy.numerics)

    return observe(experiment, values, requests, run)


class _Case(NamedTuple):
    """A gasification experiment as the kernel takes it."""

    start: FloatArray
    """Masses of the cells [kg/m2], shape (cells, components)."""
    T_start: float
    properties: arrays.Material
    network: arrays.Network
    exposure: arrays.Exposure
    probes: FloatArray
    """Positions counted in cells."""


def _lower(
    experiment: Gasification,
    material: Material,
    values: Mapping[str, float],
    accuracy: Accuracy,
    probes_m: tuple[float, ...],
) -> _Case:
    length = value_of(experiment.sample.absorption_length_m, values)
    properties = lower_material(material, values, length)
    network = lower_network(material, values)
    exposure = lower_exposure(experiment, material, properties, values)
    virgin = lower_virgin(experiment, material, values)
    cells = accuracy.cells or math.ceil(
        accuracy.cells_factor * cells_needed(virgin, properties, network, exposure)
    )
    start = lower_cells(experiment, material, properties, values, cells)
    probes = _in_cells(probes_m, start @ properties.specific_volume)
    return _Case(start, virgin.temperature, properties, network, exposure, probes)


def _march(case: _Case, factor: float, asked: Mapping[str, Request], numerics: Numerics) -> Curves:
    """Run the kernel under a multiple of the flux; return the curves asked for."""
    from pyrofit.solver.kernels.slab import slab

    status, steps, *trace, energy, mass = slab(
        case.start,
        case.T_start,
        case.properties,
        case.network,
        case.exposure._replace(flux=factor * case.exposure.flux),
        numerics,
        max(float(r.time_s[-1]) + 0.5 * r.average_s for r in asked.values()),
        set(asked) <= {"mlr", "mass"},
        case.probes,
    )
    ended = Status(status)
    signals = {}
    if ended.finished:
        initial = float(case.start.sum())
        signals = {name: _sample(name, r, trace, initial) for name, r in asked.items()}
    return Curves(ended, signals, len(case.start), int(steps), float(energy), float(mass))


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
    if not (coarse.status.finished and fine.status.finished):
        return dict.fromkeys(requests, math.nan)
    return {
        name: 4.0 / 3.0 * float(np.sqrt(np.mean((coarse.signals[name] - curve) ** 2)))
        for name, curve in fine.signals.items()
    }


def _sample(name: str, request: Request, trace: list[FloatArray], initial: float) -> FloatArray:
    from pyrofit.solver.kernels.output import held, held_rate, slopes

    time, released, rate, front, back, thickness, probes = trace
    at = request.time_s
    if name == "mlr":
        half = 0.5 * request.average_s
        if half == 0.0:
            return _floats(held_rate(time, released, rate, at))
        start = np.maximum(at - half, 0.0)
        gained = held(time, released, rate, at + half) - held(time, released, rate, start)
        return _floats(gained / np.maximum(at + half - start, 1e-9))
    if name == "mass":
        return _floats(initial - held(time, released, rate, at))
    lines = {"front_temperature": front, "back_temperature": back, "thickness": thickness}
    if name.startswith("probe_"):
        lines[name] = np.ascontiguousarray(probes[:, int(name[6:])])
    return _floats(held(time, lines[name], slopes(time, lines[name]), at))


def _in_cells(depths_m: tuple[float, ...], thickness: FloatArray) -> FloatArray:
    """Return depths in the virgin sample counted in cells, of the given thickness [m]."""
    edges = np.concatenate(([0.0], np.cumsum(thickness)))
    return _floats(np.interp(depths_m, edges, np.arange(edges.size)))


def _floats(values: object) -> FloatArray:
    return np.asarray(values, dtype=np.float64)
