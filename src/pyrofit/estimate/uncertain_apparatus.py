"""How far usual errors of the apparatus move the estimates.

A test is described by a flux, a thickness, h and temperatures that nobody knows exactly. An error e
of one of them moves the curves by u = (d curve / d e) sd(e). A fit that minimises |L^-1 (model -
data)|^2 with the curvature H makes up for it by

    d x = H^-1 J^T L^-1 u,    J = L^-1 d curve / d x.

All tests of a laboratory share an error: it sets them with one radiometer and one gauge. Errors of
different kinds are independent, so that their d x add in squares, to other errors of x as well.
Standard deviations are those of `pyrofit.experiments.slab.uncertain`. A number that is estimated
has no error here.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.problem import Problem
from pyrofit.experiments.slab.uncertain import PLACES, Place, stated, with_value
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


def moves(likelihood: Likelihood, x: FloatArray) -> FloatArray:
    """Return u of all errors, shape (points, errors), without those whose runs do not finish.

    ``x`` is the optimum, in units of the search range.
    """
    values = likelihood.values(x)
    problem, errors = _named(likelihood.problem, likelihood.problem.values(values))
    points, sets = sum(likelihood.points), 2 * len(errors)
    if not errors:
        return np.zeros((points, 0))
    columns: dict[str, float | FloatArray] = dict(problem.values(values))
    for k, (place, names) in enumerate(errors):
        for name, value in names.items():
            column = np.full(sets, value)
            column[2 * k : 2 * k + 2] += [place.sd, -place.sd]
            columns[name] = column
    curves = [
        np.concatenate(models) if status.finished else np.full(points, np.nan)
        for status, models in problem.outcomes(columns, sets)
    ]
    u = 0.5 * (np.array(curves[::2]) - np.array(curves[1::2])).T
    return np.asarray(u[:, np.all(np.isfinite(u), axis=0)])


def _named(
    problem: Problem, values: Mapping[str, float]
) -> tuple[Problem, list[tuple[Place, dict[str, float]]]]:
    """Return the problem with names for uncertain numbers, and by error these names' values."""
    runs = dict(problem.runs)
    errors: dict[str, tuple[Place, dict[str, float]]] = {}
    known: dict[tuple[str, float], str] = {}
    for run_name, run in problem.runs.items():
        experiment = run.experiment
        for key, place in PLACES.items():
            given = stated(experiment, place)
            value = values.get(given) if isinstance(given, str) else given
            if value is None or given in problem.names:
                continue
            # One value has one name, so that repeats described alike are simulated once.
            error = f"{key} {experiment.laboratory}"
            name = known.setdefault((error, value), f"error_{len(known)}")
            experiment = with_value(experiment, place, name)
            errors.setdefault(error, (place, {}))[1][name] = value
        if experiment is not run.experiment:
            runs[run_name] = replace(run, experiment=experiment)
    return (replace(problem, runs=runs) if errors else problem), list(errors.values())


def variances(C: FloatArray, jacobian: FloatArray, whitened: FloatArray) -> FloatArray:
    """Return the sum of the squares of d x of all errors, shape (parameters,).

    Parameters
    ----------
    C
        Inverse of the curvature H of what the fit minimises, shape (parameters, parameters).
    jacobian
        J of the points, shape (points, parameters).
    whitened
        L^-1 u of all errors, shape (points, errors).
    """
    return np.asarray(np.sum(linear.product(C, jacobian.T, whitened) ** 2, axis=1))
