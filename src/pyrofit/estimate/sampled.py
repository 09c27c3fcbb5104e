"""The posterior about an optimum: model discrepancy, and draws.

A discrepancy is always a part of it. Chi-square accepts many wrong models, as their parameters make
up for missing parts; where none is missing, the estimated discrepancy is small.
"""

from dataclasses import dataclass

import numpy as np

from pyrofit.estimate.discrepancy import Discrepancy, estimated, with_discrepancy
from pyrofit.estimate.ensembles import Drawn, draw
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.posterior import Posterior
from pyrofit.logs import Tell
from pyrofit.solver.arrays import FloatArray

ROUNDS = 2
"""How often the discrepancy is estimated about the optimum that it leads to."""


@dataclass(frozen=True, eq=False)
class Sampled:
    """Draws from the posterior, and their basis.

    Parameters
    ----------
    noise_alone, likelihood
        The likelihood with the noise alone, and the one that was sampled.
    discrepancies
        Discrepancies of the model, by channel.
    chi2, freedom, probability
        Of the noise alone: at its optimum, degrees of freedom, chance that noise exceeds chi2.
    x, curves
        Optimum of the likelihood that was sampled, and its simulated channels.
    drawn
        The draws.
    """

    noise_alone: Likelihood
    likelihood: Likelihood
    discrepancies: tuple[Discrepancy, ...]
    chi2: float
    freedom: float
    probability: float
    x: FloatArray
    curves: FloatArray
    drawn: Drawn


def sample(
    likelihood: Likelihood,
    start: FloatArray,
    seed: int,
    cores: int,
    most_steps: int,
    tell: Tell = lambda text: None,
) -> Sampled:
    """Draw from the posterior, with a discrepancy that is estimated from the residuals.

    Parameters
    ----------
    likelihood
        With the noise alone, and the known values.
    start
        Its optimum or a point near it, in units of the search range.
    seed, cores, most_steps, tell
        See `pyrofit.estimate.ensembles.draw`.
    """
    likelihood = likelihood.cautious
    x = likelihood.descend(start).x
    found = _about(likelihood, x)
    probability = _exceeded(found.chi2, found.freedom)
    for _ in range(ROUNDS):
        curves = _curves(likelihood, x)
        discrepancies = estimated(likelihood, x, likelihood.slopes(x), curves)
        widened = with_discrepancy(likelihood, discrepancies, curves)
        x = widened.descend(x).x
    drawn = draw(widened, x, _about(widened, x).covariance(), seed, cores, most_steps, tell)
    return Sampled(
        likelihood,
        widened,
        discrepancies,
        found.chi2,
        found.freedom,
        probability,
        x,
        _curves(likelihood, x),
        drawn,
    )


def _curves(likelihood: Likelihood, x: FloatArray) -> FloatArray:
    curves = likelihood.curves(x)
    assert curves is not None, "a descent ends at a run that finishes"
    return curves


def _about(likelihood: Likelihood, x: FloatArray) -> Posterior:
    residuals = likelihood.residuals(x)[: sum(likelihood.points)]
    return Posterior(x, residuals, likelihood.with_known(likelihood.slopes(x)))


def _exceeded(chi2: float, freedom: float) -> float:
    from scipy.stats import chi2 as distribution

    return float(distribution.sf(chi2, freedom))


def spread(drawn: Drawn, count: int) -> FloatArray:
    """Return some draws evenly over steps, walkers and ensembles, shape (count, parameters)."""
    flat = drawn.flat
    chosen = np.linspace(0, len(flat) - 1, min(count, len(flat))).round().astype(int)
    return np.asarray(flat[chosen])
