"""Uncertainty of records by the apparatus, which no further point of them averages out.

Each value a of a test's apparatus has a standard deviation, and moves the whitened record by
U_a = L^-1 (d curve / d a) sd(a) / sd. Together with the noise, of variance s^2, the record's
covariance is s^2 (I + V V^T), V = U / s; it is whitened by (I + V V^T)^(-1/2).
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.experiments.slab.uncertain import PLACES, uncertain_numbers, with_value
from pyrofit.model.experiment import Experiment
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.worth.forecast import ForecastRecord, Lasting


def of_record(fitted: FittedModel, record: ForecastRecord, dispersion: float) -> ForecastRecord:
    """Return a record with its uncertainty by the apparatus."""

    def whitened(experiment: Experiment) -> FloatArray | None:
        made = replace(record, forecast=replace(record.forecast, experiment=experiment))
        return made.whitened(fitted.model.likelihood, fitted.fit.x[None])[0]

    moves = _moves(record.forecast.experiment, whitened)
    return replace(record, lasting=lasting_of(moves, dispersion))


def of_fitted(fitted: FittedModel, dispersion: float) -> Lasting:
    """Return the uncertainty of the fitted data by the apparatus.

    The tests are taken to be independent of each other.
    """
    likelihood, x = fitted.model.likelihood, fitted.fit.x
    problem = likelihood.problem
    moves: list[FloatArray] = []
    for name, run in problem.runs.items():

        def whitened(experiment: Experiment, name: str = name) -> FloatArray | None:
            runs = {**problem.runs, name: replace(problem.runs[name], experiment=experiment)}
            made = replace(likelihood, problem=replace(problem, runs=runs))
            curves = made.curves(x)
            return None if curves is None else likelihood.whiten(curves)

        moves += _moves(run.experiment, whitened)
    return lasting_of(moves, dispersion)


def _moves(
    experiment: Experiment, whitened: Callable[[Experiment], FloatArray | None]
) -> list[FloatArray]:
    """Return the change of a whitened record by one standard deviation of each value."""
    found = []
    for key, value in uncertain_numbers(experiment).items():
        if isinstance(value, str):
            continue
        place = PLACES[key]
        ends = [whitened(with_value(experiment, place, value + d)) for d in (place.sd, -place.sd)]
        if ends[0] is not None and ends[1] is not None:
            found.append(0.5 * (ends[0] - ends[1]))
    return found


def lasting_of(moves: list[FloatArray], dispersion: float) -> Lasting:
    """Return the lasting part, from whitened changes by one standard deviation and s^2 of noise."""
    if not moves:
        return Lasting()
    V = np.column_stack(moves) / np.sqrt(dispersion)
    directions, sizes, _ = linear.svd(V)
    return Lasting(directions, 1.0 - 1.0 / np.sqrt(1.0 + sizes**2))
