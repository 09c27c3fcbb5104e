"""Whether a prediction can tell two models apart, from their own difference.

A prediction gains by an effect if the predicted curves differ by more than the noise, and by more
than the parameters leave open. These are those of the calibration, with their uncertainty, and
flux, thickness, h and clock of the predicted test. Let d be the whitened difference of the curves,
J their derivatives, and P the precision of the parameters before the test. If the model with the
effect is right, the log score is expected to gain

    min over delta of (|d - J delta|^2 + delta^T P delta) / 2.
"""

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Model, model_of
from pyrofit.diagnose.base.prediction import Predictions
from pyrofit.estimate.posterior import curvature
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


def expected_gain(own: Predictions, without: Predictions, name: str) -> float:
    """Return the gain of the log score that a prediction promises if an effect is real.

    It is infinite where a run does not finish.

    Parameters
    ----------
    own, without
        Predictions of the model with and without the effect.
    name
        Of the prediction.
    """
    return _expected(own.parts[name], without.parts[name], without.channels[name])


def _expected(own: FittedModel, without: FittedModel, channels: tuple[int, ...]) -> float:
    base, there = without.model.base, _at(without, channels)
    with_effect = _at(own, channels)
    before, after = there.residuals(without.fit.x), with_effect.residuals(own.fit.x)
    if not (there.finished(before) and with_effect.finished(after)):
        return np.inf
    d = (after - before)[: there.points]
    J: FloatArray = there.jacobian(without.fit.x, before)[: there.points]
    precision = curvature(_with_known(without, base.likelihood.problem.span.size))
    pull = linear.product(J.T, d)
    left = linear.dot(d, d) - linear.dot(pull, linear.solve(linear.gram(J) + precision, pull))
    return 0.5 * max(left, 0.0)


def _at(trial: FittedModel, channels: tuple[int, ...]) -> Model:
    return model_of(trial.model.base, trial.model.effects, channels)


def _with_known(trial: FittedModel, size: int) -> FloatArray:
    """Return the derivatives of a fit, with the known values of parameters that it does not use."""
    model, J = trial.model, trial.fit.jacobian.copy()
    prior = model.likelihood.prior
    rows = slice(model.points, model.points + len(prior.index))
    J[rows] = prior.slopes(model.likelihood.problem.span)
    assert J.shape[1] >= size
    return J
