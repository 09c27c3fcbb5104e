"""Tests that may be made: those of the kinds of experiment, repeats, sensors, calorimetry."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.config import Study
from pyrofit.diagnose.advise.candidate_experiments import ideas
from pyrofit.diagnose.advise.new_record import (
    RecordKind,
    kind_of_record,
    noise_of_record,
    requests_of,
)
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.estimate.noise import NoiseModel
from pyrofit.experiments.base import Idea
from pyrofit.experiments.dsc import Dsc
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities import known_quantities
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Place, Request
from pyrofit.solver.outputs import FRONT, HEAT_FLOW, INSIDE
from pyrofit.steps.worth.forecast import Forecast, ForecastRecord, forecast_test

INNER = next(name for name, q in known_quantities().items() if q.curve == INSIDE)
SENSORS = {FRONT: "the front temperature", INNER: "the temperature at half the depth"}
"""Quantities that a slab may record besides, in words."""
DSC_RATE_K_MIN = 10.0
DSC_LEVEL_W_KG, DSC_SLOPE_W_KGK = 100.0, 0.5
"""Standard deviations of level and slope of a calorimeter's baseline."""


@dataclass(frozen=True, eq=False)
class Planned:
    """A test with one choice of its recorded signals."""

    name: str
    words: str
    record: ForecastRecord


def planned(study: Study, fitted: FittedModel) -> tuple[list[Planned], list[str]]:
    """Return all tests that may be made, and those whose simulation does not finish.

    Parameters
    ----------
    study
        The study.
    fitted
        Its best fit to all data that are fitted.
    """
    likelihood, x = fitted.model.likelihood, fitted.fit.x
    found: list[Planned] = []
    left_out: list[str] = []
    problem = likelihood.problem
    for idea in [*ideas(problem, problem), *_again(fitted)]:
        kinds = {q: kind_of_record(fitted.model.base, q) for q in idea.most_quantities}
        requests = requests_of([fitted], idea, kinds)
        experiment = idea.change(problem.runs[idea.like].experiment)
        if INNER in requests:
            place = Place(_half_depth(experiment))
            requests[INNER] = replace(requests[INNER], output=INSIDE, place=place)
        made = forecast_test(likelihood, x, experiment, requests)
        if made is None:
            left_out += [words for _, words, _ in idea.choices]
            continue
        for name, words, quantities in idea.choices:
            noise = {q: _noise(made, q, kinds[q]) for q in quantities}
            found.append(Planned(name, words, ForecastRecord(made, noise)))
    calorimetry = _calorimetry(study, fitted)
    return [*found, *([calorimetry] if calorimetry else [])], left_out


def _noise(made: Forecast, quantity: str, kind: RecordKind) -> NoiseModel:
    return noise_of_record(kind, made.requests[quantity].time_s, made.curves[quantity])


def _again(fitted: FittedModel) -> Iterator[Idea]:
    """Yield every fitted test again, slabs also with further sensors."""
    for name, run in fitted.model.likelihood.problem.runs.items():
        experiment = run.experiment
        own = tuple(dict.fromkeys(experiment.quantity(signal).name for signal in run.requests))
        words = f"'{name}' again"
        choices = [(f"{name}_again", words, own)]
        for sensor, what in SENSORS.items():
            if _may_have(experiment, sensor) and sensor not in own:
                choice = f"{name}_again+{sensor}", f"{words}, with {what}", (*own, sensor)
                yield Idea(name, _as_it_is, (choice,))
        yield Idea(name, _as_it_is, tuple(choices))


def _as_it_is(experiment: object) -> object:
    return experiment


def _may_have(experiment: object, sensor: str) -> bool:
    if not isinstance(experiment, SlabExperiment):
        return False
    return sensor != INNER or not np.isnan(_half_depth(experiment))


def _half_depth(slab: SlabExperiment) -> float:
    """Return the depth of the middle [m]; no number where a thickness is a parameter."""
    given = [layer.thickness_m for layer in slab.sample.layers]
    return 0.5 * sum(t if isinstance(t, float) else float("nan") for t in given)


def _calorimetry(study: Study, fitted: FittedModel) -> Planned | None:
    """Return a DSC where heats of reaction or heat capacities are estimated and none is fitted.

    ASSUME: the baseline is uncertain by a level and a slope. The sensitivity of the instrument is
    known within the share by which records of repeats differ.
    """
    problem = fitted.model.likelihood.problem
    quantity = known_quantities()[HEAT_FLOW]
    fitted_kinds = {run.experiment.kind for run in problem.runs.values()}
    heated = [e for e in study.experiments.values() if isinstance(e, HeatedExperiment)]
    if "dsc" in fitted_kinds or not heated:
        return None
    like = heated[0]
    start, end = like.start_temperature_K, like.end_temperature_K
    dsc = Dsc(
        kind="dsc",
        heating_rate_K_min=DSC_RATE_K_MIN,
        start_temperature_K=start,
        end_temperature_K=end,
    )
    T = np.arange(start, end, 1.0)
    request = Request((T - T[0]) * 60.0 / DSC_RATE_K_MIN, temperature_K=T, output=HEAT_FLOW)
    made = forecast_test(fitted.model.likelihood, fitted.fit.x, dsc, {HEAT_FLOW: request})
    if made is None or not np.any(made.slopes[HEAT_FLOW]):
        return None
    noise = noise_of_record(
        kind_of_record(fitted.model.base, HEAT_FLOW), request.time_s, made.curves[HEAT_FLOW]
    )
    modes = _baseline(T, quantity.discrepancy_share * made.curves[HEAT_FLOW])
    words = f"DSC at {DSC_RATE_K_MIN:g} K/min"
    name = f"dsc_{DSC_RATE_K_MIN:g}_K_min"
    return Planned(name, words, ForecastRecord(made, {HEAT_FLOW: replace(noise, modes=modes)}))


def _baseline(T: FloatArray, sensitivity: FloatArray) -> FloatArray:
    """Return the lasting errors of a heat flow, shape (points, 3)."""
    level = np.full(T.size, DSC_LEVEL_W_KG)
    slope = DSC_SLOPE_W_KGK * (T - T.mean())
    return np.column_stack([level, slope, sensitivity])
