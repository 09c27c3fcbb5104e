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

WINDOW_K = 5.0
"""Temperature rise over which a measured heating rate is taken [K]."""


def simulate(
    experiments: Sequence[HeatedExperiment],
    material: Material,
    values: Values,
    asked: Sequence[Asked],
    accuracy: Accuracy,
    sets: int = 1,
    led: bool = False,
) -> list[list[Curves]]:
    """Return the curves by experiment and set; all in one call of the solver.

    The steps follow the programme alone, in sets that are ``led`` as in others.
    """
    runs = [(e, r) for e, of in zip(experiments, asked, strict=True) for r in of.values()]
    found = simulate_tgas(
        [e for e, _ in runs], material, values, [r for _, r in runs], accuracy, sets
    )
    curves = []
    first = 0
    for of in asked:
        own = found[first : first + len(of)]
        first += len(of)
        curves.append([_together(of, [each[s] for each in own]) for s in range(sets)])
    return curves


def _together(asked: Asked, found: Sequence[Curves]) -> Curves:
    """Return the signals of one experiment, each of a run of its own, as those of one run."""
    failed = next((c.status for c in found if not c.status.finished), None)
    if failed is not None:
        return Curves(failed, {})
    signals = {
        name: curves.signals[request.of(name)]
        for (name, request), curves in zip(asked.items(), found, strict=True)
    }
    return Curves(found[0].status, signals, steps=sum(curves.steps for curves in found))


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

    found = [reference_tga(experiment, material, values, r, resolution) for r in asked.values()]
    return _together(asked, found)


def request(
    experiment: HeatedExperiment, signal: str, frame: pd.DataFrame, times: FloatArray
) -> Request:
    """Return the request to a simulation at the given times of a measured signal."""
    return Request(
        times,
        temperature_K=programme(experiment, frame, times),
        output=experiment.quantity(signal).curve,
        heating_rate_K_s=heating_rate(experiment, frame, times),
    )


def programme(experiment: HeatedExperiment, frame: pd.DataFrame, times: FloatArray) -> FloatArray:
    """Return T [K] at the given times: the measured one, or T0 + rate (t - t0).

    Of an isothermal test the latter is at most the set point.
    """
    measured = frame["time_s"].to_numpy(float)
    temperature = frame["temperature_K"].to_numpy(float)
    if experiment.program != "nominal":
        return np.asarray(np.interp(times, measured, temperature), dtype=np.float64)
    rise = experiment.heating_rate_K_min / 60.0 * (times - measured[0])
    return _held(experiment, np.asarray(temperature[0] + rise, dtype=np.float64))


def _held(experiment: HeatedExperiment, heated: FloatArray) -> FloatArray:
    """Return a nominal programme, cut at the set point where there is one."""
    return heated if experiment.set_point_K is None else np.minimum(heated, experiment.set_point_K)


def heating_rate(
    experiment: HeatedExperiment, frame: pd.DataFrame, times: FloatArray
) -> FloatArray:
    """Return dT/dt [K/s] at the given times: the nominal one, or that of the measured programme.

    The latter is the slope between the temperatures half a window before and after, cut at the ends
    of the record. A window is the time in which the nominal temperature rises by `WINDOW_K`. The
    differences of neighbouring readings would be mostly their rounding.
    """
    nominal = experiment.heating_rate_K_min / 60.0
    if experiment.program == "nominal":
        if experiment.set_point_K is None:
            return np.full(times.size, nominal)
        below = programme(experiment, frame, times) < experiment.set_point_K
        return np.where(below, nominal, 0.0)
    measured = frame["time_s"].to_numpy(float)
    half = 0.5 * WINDOW_K / nominal
    ends = [np.clip(times + by, measured[0], measured[-1]) for by in (-half, half)]
    below, above = (
        np.interp(end, measured, frame["temperature_K"].to_numpy(float)) for end in ends
    )
    return np.asarray((above - below) / (ends[1] - ends[0]))


def synthetic(experiment: HeatedExperiment, signals: Sequence[str]) -> dict[str, Request]:
    """Return the requests of computed signals: from the first to the last temperature."""
    if experiment.set_point_K is not None:
        return _isothermal(experiment, experiment.set_point_K, signals)
    first, last = experiment.start_temperature_K, experiment.end_temperature_K
    rate = experiment.heating_rate_K_min / 60.0
    requests = {}
    for name in signals:
        temperature = np.arange(first, last, experiment.signals[name].every)
        requests[name] = Request(
            (temperature - first) / rate,
            temperature_K=temperature,
            output=experiment.quantity(name).curve,
            heating_rate_K_s=np.full(temperature.size, rate),
        )
    return requests


def _isothermal(
    experiment: HeatedExperiment, set_point_K: float, signals: Sequence[str]
) -> dict[str, Request]:
    """Return the requests of computed signals of an isothermal test, at equal steps of time."""
    first, rate = experiment.start_temperature_K, experiment.heating_rate_K_min / 60.0
    end = (set_point_K - first) / rate + experiment.hold_s
    requests = {}
    for name in signals:
        times = np.arange(0.0, end, experiment.signals[name].every / rate)
        heated = first + rate * times
        requests[name] = Request(
            times,
            temperature_K=np.minimum(heated, set_point_K),
            output=experiment.quantity(name).curve,
            heating_rate_K_s=np.where(heated < set_point_K, rate, 0.0),
        )
    return requests
