"""The solver's own error, against the noise of the measurements, and fits with finer runs."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.fit import refitted_all
from pyrofit.diagnose.base.fitted import FittedModel, finishes
from pyrofit.diagnose.base.work import bounded
from pyrofit.estimate.projection import project, projector
from pyrofit.model.accuracy import Accuracy


def solver_error(trial: FittedModel, accuracy: Accuracy) -> float:
    """Return the change of a fitted model by another accuracy, in chi-square.

    It is the sum of the squares of the change of the whitened residuals, without the part that the
    fitted parameters make up for. It is infinite where a run does not finish.
    """
    likelihood = trial.model.likelihood
    problem = replace(likelihood.problem, accuracy=accuracy)
    other = replace(trial.model, likelihood=replace(likelihood, problem=problem))
    residuals = other.residuals(trial.fit.x)
    if not other.finished(residuals):
        return float("inf")
    change = project(projector(trial.fit), residuals - trial.fit.residuals)
    return float(np.sum(change**2))


def tolerated_error(trial: FittedModel) -> float:
    """Return the solver's error in chi-square that hardly shows, the larger of two.

    Chi-square of n points of noise has the standard deviation sqrt(2 n).
    """
    scatter = float(np.sqrt(2.0 * trial.model.points))
    return max(trial.settings.most_solver_error, trial.settings.most_solver_share * scatter)


def with_accuracy(
    base: FittedModel, trials: Sequence[FittedModel], accuracy: Accuracy, processes: int = 1
) -> list[FittedModel]:
    """Return trials fitted with another accuracy, a trial itself where a run does not finish.

    Held-out runs must finish as well. The work of a run is bounded by that of the fitted base
    model.
    """
    likelihood = base.model.base.likelihood
    problem = replace(likelihood.problem, accuracy=accuracy)
    problem = bounded(problem, likelihood.values(base.fit.x), base.settings.most_work)
    other = replace(base.model.base, likelihood=replace(likelihood, problem=problem))
    fits = refitted_all(trials, other, processes)
    return [
        fit if fit.model.finished(fit.fit.residuals) and finishes(fit) else trial
        for trial, fit in zip(trials, fits, strict=True)
    ]
