"""How a sample that follows a temperature programme is simulated."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from pyrofit.experiments.base import Asked
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_tgas
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Curves, Request


def simulate(
    experiments: Sequence[HeatedExperiment],
    material: Material,
    values: Values,
    asked: Sequence[Asked],
    accuracy: Accuracy,
    sets: int = 1,
) -> list[list[Curves]]:
    """Return the curves by experiment and set; all in one call of the solver."""
    requests = [request for (request,) in (of.values() for of in asked)]
    return simulate_tgas(experiments, material, values, requests, accuracy, sets)


def reference(
    experiment: HeatedExperiment,
    material: Material,
    values: Mapping[str, float],
    asked: Asked,
    resolution: Resolution,
) -> Curves:
    """Return the curves of the reference solver."""
    # Not above: loading its integrator takes a quarter of the time of a small job.
    from pyrofit.solver.reference.tga import reference_tga

    (request,) = asked.values()
    return reference_tga(experiment, material, values, request, resolution)


def request(
    experiment: HeatedExperiment, signal: str, frame: pd.DataFrame, times: FloatArray
) -> Request:
    """Return what a simulation is asked for at the given times of a measured signal."""
    return Request(times, temperature_K=programme(experiment, frame, times))


def programme(experiment: HeatedExperiment, frame: pd.DataFrame, times: FloatArray) -> FloatArray:
    """Return T [K] at the given times: the measured one, or T0 + rate (t - t0)."""
    measured = frame["time_s"].to_numpy(float)
    temperature = frame["temperature_K"].to_numpy(float)
    if experiment.program == "measured":
        return np.asarray(np.interp(times, measured, temperature), dtype=np.float64)
    rise = experiment.heating_rate_K_min / 60.0 * (times - measured[0])
    return np.asarray(temperature[0] + rise, dtype=np.float64)


def synthetic(experiment: HeatedExperiment, signals: Sequence[str]) -> dict[str, Request]:
    """Return the requests of computed signals: from the first to the last temperature."""
    first, last = experiment.start_temperature_K, experiment.end_temperature_K
    requests = {}
    for name in signals:
        temperature = np.arange(first, last, experiment.signals[name].every)
        time = (temperature - first) / (experiment.heating_rate_K_min / 60.0)
        requests[name] = Request(time, temperature_K=temperature)
    return requests
