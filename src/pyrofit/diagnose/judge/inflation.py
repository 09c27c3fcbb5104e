"""How much less the points of a signal tell where a model still misfits.

Misfit lasts over many points, so sums of whitened residuals w vary more than those of noise. With
windows of L points, a tenth of the record, a signal's factor is the larger one of

    f = mean over windows of (sum of w)^2 / L    and    chi-square per point,    1 at least.

The first is the long-run variance with Bartlett's weights (Newey and West 1987,
doi 10.2307/1913610). The variance of the signal's noise counts as f times as large.
"""

from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.estimate.apparatus import LASTING
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True)
class Inflation:
    """Factors of the variance of the noise, by calibrated signal."""

    factors: tuple[float, ...]

    @property
    def inflates(self) -> bool:
        """Whether there is misfit."""
        return any(factor > 1.0 for factor in self.factors)

    def rows(self, trial: FittedModel) -> FloatArray:
        """Return the factors of the residuals of a model, 1/sqrt(f); 1 for known values."""
        scales = 1.0 / np.sqrt(self.factors)
        of_points = np.repeat(scales, trial.model.likelihood.points)
        known = np.ones(trial.fit.residuals.size - of_points.size)
        return np.concatenate([of_points, known])

    def chi2(self, trial: FittedModel) -> float:
        """Return chi-square of a model with the noise of this variance."""
        w = self.rows(trial) * trial.fit.residuals
        return linear.dot(w, w)

    def penalised(self, trial: FittedModel) -> float:
        """Return that chi-square with the price of the parameters of the effects."""
        return self.chi2(trial) + trial.price


def inflation_of(found: Search) -> Inflation:
    """Return the inflation by the misfit of a search's end, none where it leaves only noise."""
    return none_for(found.end) if found.end_lack.adequate else by_misfit(found.end)


def none_for(trial: FittedModel) -> Inflation:
    """Return the factors 1 for the signals of a model."""
    return Inflation((1.0,) * len(trial.model.channels))


def by_misfit(trial: FittedModel) -> Inflation:
    """Return the inflation by the residuals of a model."""
    return Inflation(tuple(map(factor_of, trial.model.by_channel(trial.fit.residuals))))


def factor_of(w: FloatArray) -> float:
    """Return the factor of a signal with whitened residuals w."""
    return max(1.0, long_run_variance(w), float(np.mean(w**2)))


def long_run_variance(w: FloatArray) -> float:
    """Return the variance of sums over a tenth of a series, per point.

    >>> long_run_variance(np.ones(100)), long_run_variance(np.tile([1.0, -1.0], 50))
    (10.0, 0.0)
    """
    length = max(1, round(LASTING * w.size))
    total = np.concatenate([[0.0], np.cumsum(w)])
    sums = total[length:] - total[:-length]
    return float(np.mean(sums**2) / length)
