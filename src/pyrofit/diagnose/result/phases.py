"""Windows of disagreement as a fire researcher names them: conversion, temperatures, phase."""

from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Model
from pyrofit.estimate.scan import Stretch
from pyrofit.experiments import kind_of
from pyrofit.experiments.base import Course
from pyrofit.results.diagnosis_schema import OfWindow
from pyrofit.solver.arrays import FloatArray


def describe_windows(
    name: str, trial: FittedModel, windows: tuple[Stretch, ...], critical: float
) -> list[OfWindow]:
    """Return the windows of a model in physical terms, differences simulated less measured."""
    model = trial.model
    courses = {w.channel: course_of_channel(model, trial.fit.x, w.channel) for w in windows}
    return [_window(name, trial, w, courses[w.channel], critical) for w in windows]


def _window(of_model: str, trial: FittedModel, w: Stretch, of: Course, critical: float) -> OfWindow:
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
    return OfWindow(
        model=of_model,
        experiment=name,
        signal=signal,
        start_s=float(target.time_s[w.start]),
        end_s=float(target.time_s[w.end - 1]),
        start_K=None if T is None else float(T[0]),
        end_K=None if T is None else float(T[-1]),
        conversion=_ends(of.conversion[part]),
        surface_temperature_K=None if surface is None else _ends(surface[part]),
        phase=of.phases[int(np.sort(of.phase[part])[(w.end - w.start) // 2])],
        sign=1 if mean > 0.0 else -1,
        mean=mean,
        relative=mean / level if level > 0.0 else None,
        unit=run.experiment.quantity(signal).unit_text,
        statistic=w.statistic,
        critical=critical,
    )


def _ends(values: FloatArray) -> list[float]:
    return [float(values[0]), float(values[-1])]


def course_of_channel(model: Model, x: FloatArray, channel: int) -> Course:
    """Return the simulated course of a channel's experiment at the channel's times."""
    problem = model.likelihood.problem
    name, signal, index = problem.picks[channel]
    run = problem.runs[name]
    values = problem.values(model.likelihood.values(x))
    request = run.requests[signal]
    kind = kind_of(run.experiment)
    full = kind.course(run.experiment, problem.material, values, request, problem.accuracy)
    surface = full.surface_temperature_K
    return replace(
        full,
        conversion=full.conversion[index],
        surface_temperature_K=None if surface is None else surface[index],
        phase=full.phase[index],
    )
