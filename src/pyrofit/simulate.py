"""Curves of an experiment for given parameter values."""

from collections.abc import Mapping

import numpy as np
from pydantic import Field

from pyrofit.model.base import Part, value_of
from pyrofit.model.experiment import Gasification, Tga
from pyrofit.model.material import Material
from pyrofit.solver import lower
from pyrofit.solver.arrays import FloatArray, Numerics, Status
from pyrofit.solver.curves import Curves, Request

NO_PROBES = np.empty(0)


class Accuracy(Part):
    """How finely the slab and TGA equations are solved."""

    cells: int = Field(50, ge=2, le=5000, description="cells of the slab")
    tolerance: float = Field(
        3e-3, gt=0.0, le=0.1, description="bound on the scaled predictor-corrector difference"
    )
    first_step_s: float = Field(0.01, gt=0.0, description="first time step [s]")
    longest_step_s: float = Field(10.0, gt=0.0, description="longest time step [s]")
    most_steps: int = Field(20000, ge=100, description="steps after which a run is given up")
    tga_step_K: float = Field(1.0, gt=0.0, description="largest temperature rise of a TGA step [K]")

    @property
    def numerics(self) -> Numerics:
        """The same for the kernel."""
        return Numerics(self.tolerance, self.first_step_s, self.longest_step_s, self.most_steps)


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
    network = lower.lower_network(material, values, heats=False)
    start = lower.fractions(material.composition, list(material.components), values)
    mass, rate = tga(request.time_s, request.temperature_K, start, network, accuracy.tga_step_K)
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
    from pyrofit.solver.kernels.slab import slab

    accuracy = accuracy or Accuracy()
    arrays = lower.lower_material(material, values)
    start = lower.lower_cells(experiment, material, arrays, values, accuracy.cells)
    t_end = max(float(r.time_s[-1]) + 0.5 * r.average_s for r in requests.values())
    thickness = sum(value_of(layer.thickness_m, values) for layer in experiment.sample.layers)
    status, steps, *trace, energy, mass = slab(
        start,
        value_of(experiment.sample.initial_temperature_K, values),
        arrays,
        lower.lower_network(material, values),
        lower.lower_exposure(experiment, material, arrays, values),
        accuracy.numerics,
        t_end,
        set(requests) <= {"mlr", "mass"},
        np.array(probes_m) / thickness * len(start) if probes_m else NO_PROBES,
    )
    ended = Status(status)
    signals = {}
    if ended.finished:
        initial = float(start.sum())
        signals = {name: _sample(name, r, trace, initial) for name, r in requests.items()}
    return Curves(ended, signals, int(steps), float(energy), float(mass))


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
        return _floats(gained / (at + half - start))
    if name == "mass":
        return _floats(initial - held(time, released, rate, at))
    lines = {"front_temperature": front, "back_temperature": back, "thickness": thickness}
    if name.startswith("probe_"):
        lines[name] = np.ascontiguousarray(probes[:, int(name[6:])])
    return _floats(held(time, lines[name], slopes(time, lines[name]), at))


def _floats(values: object) -> FloatArray:
    return np.asarray(values, dtype=np.float64)
