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
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.problem import Problem
from pyrofit.experiments.slab.uncertain import PLACES, Place, uncertain_numbers, with_value
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Moves:
    """How far errors move curves.

    Parameters
    ----------
    names
        The errors in words.
    u
        Changes of all curves by one standard deviation, shape (points, errors).
    """

    names: tuple[str, ...]
    u: FloatArray

    def of_parameters(
        self, likelihood: Likelihood, C: FloatArray, jacobian: FloatArray
    ) -> tuple[FloatArray, tuple[str, ...]]:
        """Return by parameter the standard deviation of d x, and the error that moves it most.

        Parameters
        ----------
        likelihood
            What the fit minimises.
        C
            Inverse of its curvature H, shape (parameters, parameters).
        jacobian
            J of the points, shape (points, parameters).
        """
        dx = np.abs(linear.product(C, jacobian.T, likelihood.whiten(self.u)))
        if not self.names:
            return np.zeros(len(C)), ("",) * len(C)
        most = tuple(self.names[int(np.argmax(row))] if row.any() else "" for row in dx)
        return np.asarray(np.sqrt(np.sum(dx**2, axis=1))), most


def moves(likelihood: Likelihood, x: FloatArray) -> Moves:
    """Return the moves by all errors, without those whose runs do not finish.

    ``x`` is the optimum, in units of the search range.
    """
    values = likelihood.values(x)
    problem, errors = _named(likelihood.problem, likelihood.problem.values(values))
    points, sets = sum(likelihood.points), 2 * len(errors)
    if not errors:
        return Moves((), np.zeros((points, 0)))
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
    finished = np.all(np.isfinite(u), axis=0)
    names_of = [place.words for (place, _), ends in zip(errors, finished, strict=True) if ends]
    return Moves(tuple(names_of), np.asarray(u[:, finished]))


def _named(
    problem: Problem, values: Mapping[str, float]
) -> tuple[Problem, list[tuple[Place, dict[str, float]]]]:
    """Return the problem with names for uncertain numbers, and by error these names' values."""
    runs = dict(problem.runs)
    errors: dict[str, tuple[Place, dict[str, float]]] = {}
    known: dict[tuple[str, float], str] = {}
    for run_name, run in problem.runs.items():
        experiment = run.experiment
        for key, given in uncertain_numbers(experiment).items():
            value = values.get(given) if isinstance(given, str) else given
            if value is None or given in problem.names:
                continue
            # One value has one name, so that repeats described alike are simulated once.
            error = f"{key} {experiment.laboratory}"
            name = known.setdefault((error, value), f"error_{len(known)}")
            experiment = with_value(experiment, PLACES[key], name)
            errors.setdefault(error, (PLACES[key], {}))[1][name] = value
        if experiment is not run.experiment:
            runs[run_name] = replace(run, experiment=experiment)
    return (replace(problem, runs=runs) if errors else problem), list(errors.values())
