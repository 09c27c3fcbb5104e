"""Predictions of records that a scheme was not fitted to."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.numerics import linear
from pyrofit.scheme.fit import FittedScheme, SchemeSetting, fit_posed, problem_of
from pyrofit.scheme.noise import log_density_of_noise
from pyrofit.scheme.records import MassRecord, rates_of
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class PredictedRecord:
    """A record that a scheme predicts.

    Parameters
    ----------
    record
        The record.
    curve
        Predicted mass over initial mass at its points.
    log_score
        Log density of the record given those that the scheme was fitted to.
    """

    record: MassRecord
    curve: FloatArray
    log_score: float

    @property
    def rms(self) -> float:
        """Root mean square of predicted minus measured mass fraction."""
        return root_mean_square(self.curve - self.record.mass)


def leave_rates_out(
    setting: SchemeSetting, fitted: FittedScheme, seed: int
) -> list[PredictedRecord]:
    """Predict each heating rate from a fit to the others."""
    found = []
    for rate in rates_of(setting.calibrated):
        rest = [r for r in setting.calibrated if r.rate != rate]
        left = [r for r in setting.calibrated if r.rate == rate]
        rng = np.random.default_rng(seed)
        start, size = [fitted.values], fitted.size
        few = fit_posed(setting, fitted.posed, rest, start, rng, size, random=0)
        found += predict_records(setting, few, left)
    return found


def predict_records(
    setting: SchemeSetting, fitted: FittedScheme, records: Sequence[MassRecord]
) -> list[PredictedRecord]:
    """Predict records; the density has the uncertainty of the parameters, linearly.

    The residual of a record has the covariance C + J S J^T: J are the derivatives of its curve
    by the parameters, S their covariance, C has the size of the fit.
    """
    spread = fitted.spread()
    found = []
    for record in records:
        problem, prior = problem_of(setting, fitted.posed, [record])
        (scatter,) = setting.scatters([record])
        likelihood = Likelihood(problem, (scatter.noise(fitted.size),), prior)
        slopes = likelihood.slopes(fitted.x)
        curve = likelihood.curves(fitted.x)
        if curve is None:
            curve = np.zeros(record.mass.size)
        total = scatter.covariance(fitted.size) + linear.product(slopes, spread, slopes.T)
        score = log_density_of_noise(curve - record.mass, total)
        found.append(PredictedRecord(record, curve, score))
    return found
