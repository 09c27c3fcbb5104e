"""Robustness of the cost functions: twins of known truth with stronger noise and with outliers.

A twin is the study's own experiment: the curve of the model itself at known parameter values, with
noise, is fitted like the measurement. Whatever is found besides the truth is the doing of noise,
outliers, cost function and search, as the model is right.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study, TermSpec
from pyrofit.errors import DataError
from pyrofit.estimate.least_squares import multistart
from pyrofit.estimate.noise import estimate_noise
from pyrofit.estimate.pose import of_imp, pose
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements, target_of
from pyrofit.logs import Tell
from pyrofit.quantities.base import Quantity
from pyrofit.results.files import Results, write_csv
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.recorded import load
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.robustness.options import RobustnessOptions
from pyrofit.steps.robustness.twins import NOISE, OUTLIERS, true_set

Channel = tuple[str, str]


@dataclass(frozen=True)
class NoisyTwin:
    """Curves at the truth, SI units, with the noise of the measurement.

    Parameters
    ----------
    clean
        The measured series with the curves of the model in the place of the measured values.
    sd
        Standard deviation of each series' noise, shape (n,).
    """

    clean: Mapping[Channel, pd.DataFrame]
    sd: Mapping[Channel, FloatArray]


def run(study: Study, results: Results, tell: Tell, processes: int, cost: str) -> None:
    """Fit twins with one cost function; write ``robustness/<cost>.csv``.

    One row per twin: the disturbance, the lowest cost and its set, and ``prediction_error``. That
    is the mean CV(RMSE) of the mass loss rate at held-out experiments, against the truth.

    Raises
    ------
    DataError
        A result is missing, or the model does not finish at the truth.
    """
    twin = _twin(study, results)
    held_out = _held_out(study, results, twin)
    budget = study.options(RobustnessOptions)
    rows = []
    for kind, level, draw in plan(study):
        series = noisy(study, twin, kind, level, draw)
        problem = _problem(study, results, study.imp.costs[cost], series)
        seed = seed_for(study.seed, "robustness", kind, level, draw, "starts")
        best = multistart(problem, budget.starts, seed)[0]
        errors = [other.evaluate(best.values).cost for other in held_out]
        about = {"cost_function": cost, "kind": kind, "level": level, "draw": draw}
        about |= {"cost": best.cost, "calls": best.calls}
        about["prediction_error"] = float(np.mean(errors)) if errors else None
        rows.append({**about, **dict(zip(problem.names, best.values.tolist(), strict=True))})
    write_csv(results.of_step("robustness", f"{cost}.csv"), pd.DataFrame(rows))


def plan(study: Study) -> Iterator[tuple[str, float, int]]:
    """Yield the disturbance of each twin: kind, level, number of the draw."""
    budget = study.options(RobustnessOptions)
    levels = {NOISE: budget.noise, OUTLIERS: budget.outliers}
    for kind, values in levels.items():
        for level in values:
            for draw in range(budget.draws):
                yield kind, level, draw


def _twin(study: Study, results: Results) -> NoisyTwin:
    measured = load(study, results)
    truth = true_set(study, results)
    channels = {(t.experiment, t.signal) for terms in study.imp.costs.values() for t in terms}
    channels |= set(_predicted_rates(study))
    clean, sd = {}, {}
    for name, signal in sorted(channels):
        frame = measured[name, signal]
        spec = TermSpec(experiment=name, signal=signal, kind="RMSE")
        status, curves = _problem(study, results, [spec], measured).simulate(truth)
        if not status.finished:
            raise DataError(f"{name}: no twin can be made: {status.explanation}")
        quantity = study.experiments[name].quantity(signal)
        clean[name, signal] = with_values(frame, quantity, curves[0])
        described = study.experiments[name].signals[signal]
        noise = estimate_noise(
            target_of(frame, quantity), quantity, described.uncertainty_sds, described.timing_s
        )
        sd[name, signal] = noise.sd
    return NoisyTwin(clean, sd)


def _predicted_rates(study: Study) -> list[tuple[str, str]]:
    """Return experiment and signal of the predicted rates, which are scored by their mean."""
    return [
        (name, signal)
        for name in study.validation.experiments
        for signal in study.experiments[name].signals
        if study.experiments[name].quantity(signal).relative
    ]


def noisy(study: Study, twin: NoisyTwin, kind: str, level: float, draw: int) -> Measurements:
    """Return the series of a twin with noise and, perhaps, outliers.

    The noise is white. A stated uncertainty grows with it, but not with outliers.
    """
    series = {}
    for (name, signal), frame in twin.clean.items():
        # The same for every cost function, so that they are compared on the same data.
        rng = np.random.default_rng(seed_for(study.seed, "robustness", level, draw, name, signal))
        quantity = study.experiments[name].quantity(signal)
        value = frame[quantity.column].to_numpy(float)
        multiple = level if kind == NOISE else 1.0
        added = multiple * twin.sd[name, signal] * rng.standard_normal(value.size)
        if kind == OUTLIERS:
            hit = rng.random(value.size) < level
            size = study.options(RobustnessOptions).outlier_size * float(np.ptp(value))
            added += np.where(hit, size * rng.choice([-1.0, 1.0], value.size), 0.0)
        series[name, signal] = with_values(frame, quantity, value + added, multiple)
    return series


def with_values(
    frame: pd.DataFrame, quantity: Quantity, value: FloatArray, wider: float = 1.0
) -> pd.DataFrame:
    """Return a series with other values; their stated uncertainty and limits move along.

    Parameters
    ----------
    frame
        The measured series.
    quantity
        Its quantity.
    value
        New values, shape (n,).
    wider
        Factor of the uncertainty and of the distances to the limits.
    """
    columns: dict[str, FloatArray | pd.Series] = {quantity.column: value}
    if quantity.uncertainty_column in frame:
        columns[quantity.uncertainty_column] = wider * frame[quantity.uncertainty_column]
    for limit in quantity.limit_columns.values():
        if limit in frame:
            columns[limit] = value + wider * (frame[limit] - frame[quantity.column])
    return frame.assign(**columns)


def _held_out(study: Study, results: Results, twin: NoisyTwin) -> list[Problem]:
    """Return problems whose cost is the CV(RMSE) against the truth, where nothing is fitted."""
    fitted = {t.experiment for terms in study.imp.costs.values() for t in terms if t.weight}
    specs = [
        TermSpec(experiment=name, signal=signal, kind="RMSE", normalisation="mean")
        for name, signal in _predicted_rates(study)
        if name not in fitted and (name, signal) in twin.clean
    ]
    return [_problem(study, results, [spec], twin.clean) for spec in specs]


def _problem(study: Study, results: Results, specs: Any, series: Measurements) -> Problem:
    return pose(study, of_imp(study, specs), series, fixed_for_imp(study, results))
