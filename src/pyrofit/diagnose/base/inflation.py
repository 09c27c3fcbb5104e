"""The larger variance that the noise of a model with misfit counts with, see `long_run`."""

from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.long_run import long_run_factor, significant_factor
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


def none_for(trial: FittedModel) -> Inflation:
    """Return the factors 1 for the signals of a model."""
    return Inflation((1.0,) * len(trial.model.channels))


def by_misfit(trial: FittedModel) -> Inflation:
    """Return the inflation by the residuals of a model."""
    return Inflation(tuple(map(long_run_factor, trial.model.by_channel(trial.fit.residuals))))


def by_significant_misfit(trial: FittedModel) -> Inflation:
    """Return the inflation by misfit that noise hardly reaches."""
    parts, level = trial.model.by_channel(trial.fit.residuals), trial.settings.lasting_level
    return Inflation(tuple(significant_factor(part, level) for part in parts))
