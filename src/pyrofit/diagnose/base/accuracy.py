"""The solver's own error, against the noise of the measurements."""

from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.projection import project, projector
from pyrofit.model.accuracy import Accuracy


def solver_error(trial: FittedModel, accuracy: Accuracy) -> float:
    """Return the change of a fitted model by another accuracy, in chi-square.

    It is the sum of the squares of the change of the whitened residuals, without the part that the
    fitted parameters make up for. It is infinite where a run does not finish.
    """
    likelihood = trial.model.likelihood
    other = replace(likelihood, problem=replace(likelihood.problem, accuracy=accuracy))
    residuals = other.residuals(trial.fit.x)
    if not other.finished(residuals):
        return float("inf")
    change = project(projector(trial.fit), residuals - trial.fit.residuals)
    return float(np.sum(change**2))
