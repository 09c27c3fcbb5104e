"""Fits of a model with a free correction."""

from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend_chi_square
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Model
from pyrofit.diagnose.corrections.correction import Correction
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.prior import NormalPrior
from pyrofit.solver.arrays import FloatArray


def corrected(trial: FittedModel, correction: Correction, x: FloatArray | None = None) -> Fit:
    """Fit all parameters and the coefficients, from x or the model's fit, where these are zero."""
    none = np.full(len(correction.sd), 0.5)
    start = np.append(trial.fit.x if x is None else x, none)
    return descend_chi_square(with_coefficients(trial.model, correction), start)


def with_coefficients(model: Model, correction: Correction) -> Model:
    """Return the model with a correction; its coefficients follow all other parameters."""
    problem, known = correction.problem, model.likelihood.prior
    widest = model.base.settings.widest_correction
    sd = np.array(list(correction.sd.values()))
    count = len(problem.names)
    wider = replace(
        problem,
        names=(*problem.names, *correction.sd),
        lower=np.append(problem.lower, -widest * sd),
        upper=np.append(problem.upper, widest * sd),
    )
    prior = NormalPrior(
        index=(*known.index, *range(count, count + sd.size)),
        mean=np.append(known.mean, np.zeros(sd.size)),
        sd=np.append(known.sd, sd),
    )
    return replace(model, likelihood=Likelihood(wider, model.likelihood.noise, prior))
