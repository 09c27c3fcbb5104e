"""Windows of disagreement as a fire researcher names them: conversion, temperatures, phase.

Phases of a gasification, from the simulated curves: *heat-up* until the mass loss rate reaches a
tenth of its largest value; *onset* until it reaches 0.8 of its median between conversions of 0.2
and 0.8; *plateau* until the back has warmed by a tenth of what the front has; *back-effect* until
nine tenths of the volatile mass are gone; *burn-out* until 0.99 are; then *tail*. Of a TGA, from
the simulated conversion: *heat-up* to 0.02, *onset* to 0.2, *plateau* to 0.9, *burn-out* to 0.99.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pyrofit.diagnose.locate import Stretch
from pyrofit.diagnose.model import Model
from pyrofit.diagnose.refit import Trial
from pyrofit.estimate.noise import UNITS
from pyrofit.model.experiment import Gasification
from pyrofit.simulate import simulate_gasification, simulate_tga
from pyrofit.solver.arrays import FloatArray

PHASES = ("heat-up", "onset", "plateau", "back-effect", "burn-out", "tail")
_STARTED, _RISEN, _WARMED, _NEARLY, _GONE = 0.1, 0.8, 0.1, 0.9, 0.99
_TGA_ENDS = (0.02, 0.2, 0.9, 0.9, 0.99)


@dataclass(frozen=True, eq=False)
class Course:
    """The simulated course of an experiment at the times of a channel, shape (n,) each."""

    conversion: FloatArray
    surface_temperature_K: FloatArray | None
    phase: FloatArray
    """Position among `PHASES`."""


def describe(
    trial: Trial, windows: tuple[Stretch, ...], critical: float
) -> list[dict[str, object]]:
    """Return each window in physical terms, the differences simulated less measured."""
    model = trial.model
    courses = {w.channel: course(model, trial.fit.x, w.channel) for w in windows}
    return [_window(trial, w, courses[w.channel], critical) for w in windows]


def _window(trial: Trial, w: Stretch, of: Course, critical: float) -> dict[str, object]:
    model = trial.model
    problem = model.likelihood.problem
    name, signal, _ = problem.picks[w.channel]
    target = problem.cost.terms[w.channel][1].target
    part = slice(w.start, w.end)
    curves = model.likelihood.curves(trial.fit.x)
    assert curves is not None
    simulated = model.likelihood.split(curves)[w.channel]
    mean = float(np.mean((simulated - target.value)[part]))
    level = float(np.mean(np.abs(target.value[part])))
    run = problem.runs[name]
    at = run.requests[signal].temperature_K
    T = None if at is None else at[problem.picks[w.channel][2]][part]
    surface = of.surface_temperature_K
    return {
        "experiment": name,
        "signal": signal,
        "start_s": float(target.time_s[w.start]),
        "end_s": float(target.time_s[w.end - 1]),
        "start_K": None if T is None else float(T[0]),
        "end_K": None if T is None else float(T[-1]),
        "conversion": _ends(of.conversion[part]),
        "surface_temperature_K": None if surface is None else _ends(surface[part]),
        "phase": PHASES[int(np.sort(of.phase[part])[(w.end - w.start) // 2])],
        "sign": 1 if mean > 0.0 else -1,
        "mean": mean,
        "relative": mean / level if level > 0.0 else None,
        "unit": UNITS[signal],
        "statistic": w.statistic,
        "critical": critical,
    }


def _ends(values: FloatArray) -> list[float]:
    return [float(values[0]), float(values[-1])]


def course(model: Model, x: FloatArray, channel: int) -> Course:
    """Return the simulated course of a channel's experiment at the channel's times."""
    problem = model.likelihood.problem
    name, signal, index = problem.picks[channel]
    run = problem.runs[name]
    values = problem.values(model.likelihood.values(x))
    request = run.requests[signal]
    if not isinstance(run.experiment, Gasification):
        curves = simulate_tga(run.experiment, problem.material, values, request, problem.accuracy)
        return _of_tga(curves.signals["mass_fraction"][index])
    names = ("mlr", "mass", "front_temperature", "back_temperature")
    requests = {n: replace(request, average_s=0.0) for n in names}
    curves = simulate_gasification(
        run.experiment, problem.material, values, requests, problem.accuracy
    )
    return _of_slab({n: curve[index] for n, curve in curves.signals.items()})


def _of_tga(mass: FloatArray) -> Course:
    conversion = _conversion(mass)
    return Course(conversion, None, np.searchsorted(_TGA_ENDS, conversion).astype(float))


def _of_slab(curves: Mapping[str, FloatArray]) -> Course:
    rate, front, back = (curves[n] for n in ("mlr", "front_temperature", "back_temperature"))
    X = _conversion(curves["mass"])
    middle = (X > 0.2) & (X < 0.8)
    level = float(np.median(rate[middle])) if middle.any() else float(rate.max())
    started = _since(rate >= _STARTED * rate.max())
    risen = started & _since(rate >= _RISEN * level)
    warmed = _since((front > front[0]) & (back - back[0] > _WARMED * (front - front[0])))
    phase = np.zeros(X.size)
    for k, passed in enumerate((started, risen, risen & warmed, X >= _NEARLY, X >= _GONE), 1):
        phase[passed] = k
    return Course(X, front, phase)


def _since(reached: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tell from when on something has been reached."""
    return np.asarray(np.maximum.accumulate(reached))


def _conversion(mass: FloatArray) -> FloatArray:
    """Return the released share of all that is released in the record."""
    released = mass[0] - mass
    return np.asarray(released / max(float(released[-1]), 1e-12))
