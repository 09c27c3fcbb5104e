"""How a test is simulated by an external program."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import pandas as pd

from pyrofit.errors import StudyError
from pyrofit.experiments.base import Asked, Course, Idea
from pyrofit.external.output import WrittenCurve
from pyrofit.external.runs import Outcome, outcomes
from pyrofit.model.accuracy import Accuracy, Resolution
from pyrofit.model.base import value_of
from pyrofit.model.external import ExternalExperiment
from pyrofit.model.material import Material
from pyrofit.solver.arrays import FloatArray, Status, Values
from pyrofit.solver.curves import Curves, Request

OWN_MODEL = (
    "an external program has a model of its own, which no effect changes. The "
    "diagnosis and new experiments need one of pyrofit's kinds of experiment, such as "
    "`kind: gasification`"
)


def simulate(
    experiments: Sequence[ExternalExperiment],
    material: Material,
    values: Values,
    asked: Sequence[Asked],
    accuracy: Accuracy,
    sets: int = 1,
    led: bool = False,
) -> list[list[Curves]]:
    """Return the curves by experiment and set. No set leads another in an external program."""
    columns = {name: np.broadcast_to(x, sets).tolist() for name, x in values.items()}
    each = [{name: float(column[s]) for name, column in columns.items()} for s in range(sets)]
    return [_simulate(e, each, of) for e, of in zip(experiments, asked, strict=True)]


def _simulate(
    experiment: ExternalExperiment, sets: Sequence[Mapping[str, float]], asked: Asked
) -> list[Curves]:
    """Return the curves of an experiment by set."""
    program = experiment.program
    quantities = {name: experiment.quantity(name) for name in program.reads}
    found = outcomes(program, quantities, last_needed(experiment, asked), sets)
    return [_curves(experiment, v, asked, o) for v, o in zip(sets, found, strict=True)]


def last_needed(experiment: ExternalExperiment, asked: Asked) -> dict[str, float]:
    """Return the last time [s] or temperature [K] that each curve must reach."""
    return {
        name: float(
            request.time_s.max()
            if experiment.program.reads[name].abscissa == "time"
            else request.programme()[0].max()
        )
        for name, request in asked.items()
    }


def _curves(
    experiment: ExternalExperiment, values: Mapping[str, float], asked: Asked, outcome: Outcome
) -> Curves:
    """Return the signals of a run at the requested times, as the apparatus records them.

    y(t) = offset + m(t - delay), m the mean over the bin of the request.
    """
    if outcome.why:
        return Curves(Status.PROGRAM_FAILED, {})
    signals = {}
    for name, request in asked.items():
        signal, record = experiment.signals[name], outcome.records[name]
        if experiment.program.reads[name].abscissa == "time":
            at = request.time_s - value_of(signal.delay_s, values)
        else:
            at = request.programme()[0]
        signals[name] = mean(record, at, request.average_s) + value_of(signal.offset, values)
    return Curves(Status.OK, signals)


def mean(record: WrittenCurve, at: FloatArray, width: float) -> FloatArray:
    """Return means over bins of a curve, linear between its points and constant beyond its ends.

    >>> mean(WrittenCurve(np.array([0.0, 2.0]), np.array([0.0, 2.0])), np.array([0.5, 1.0]), 1.0)
    array([0.5, 1. ])
    """
    if width <= 0.0:
        return np.asarray(np.interp(at, record.at, record.value))
    x, y = record
    total = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])

    def integral(t: FloatArray) -> FloatArray:
        left = np.clip(np.searchsorted(x, t, side="right") - 1, 0, x.size - 1)
        inside = total[left] + 0.5 * (t - x[left]) * (y[left] + np.interp(t, x, y))
        return np.asarray(np.where(t < x[0], (t - x[0]) * y[0], inside))

    return (integral(at + 0.5 * width) - integral(at - 0.5 * width)) / width


def reference(
    experiment: ExternalExperiment,
    material: Material,
    values: Mapping[str, float],
    asked: Asked,
    resolution: Resolution,
) -> Curves:
    """Return the curves of the same program, as there is no reference solver."""
    return simulate([experiment], material, values, [asked], Accuracy())[0][0]


def request(
    experiment: ExternalExperiment, signal: str, frame: pd.DataFrame, times: FloatArray
) -> Request:
    """Return the request of a signal at the given times."""
    temperature = None
    if "temperature_K" in frame:
        recorded = frame["time_s"].to_numpy(float), frame["temperature_K"].to_numpy(float)
        temperature = np.asarray(np.interp(times, *recorded))
    return Request(times, experiment.signals[signal].average_s, temperature_K=temperature)


def synthetic(experiment: ExternalExperiment, signals: Sequence[str]) -> dict[str, Request]:
    """Return the requests of computed signals: points in the middle of equal bins."""
    requests = {}
    for name in signals:
        signal = experiment.signals[name]
        times = np.arange(0.5 * signal.every, experiment.duration_s, signal.every)
        requests[name] = Request(times, signal.average_s)
    return requests


def course(
    experiment: ExternalExperiment,
    material: Material,
    values: Mapping[str, float],
    request: Request,
    accuracy: Accuracy,
) -> Course:
    """Refuse, as the state inside the sample is not known.

    Raises
    ------
    StudyError
        Always.
    """
    raise StudyError(OWN_MODEL)


def designs(
    own: Mapping[str, ExternalExperiment],
    measured: Mapping[str, ExternalExperiment],
    recorded: Mapping[str, set[str]],
) -> Iterator[Idea]:
    """Yield no new test: the template describes one test only."""
    yield from ()
