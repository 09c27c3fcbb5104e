"""The check by drawn data: nonlinear refits with and without a further record."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.estimate.bounded_least_squares import minimise
from pyrofit.estimate.derivatives import derivatives
from pyrofit.estimate.likelihood import FAILED
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.seeds import seed_for
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.worth.forecast import Forecast, ForecastRecord, Lasting, simulated_curves

ENOUGH = 1e-3
"""A refit ends where the next step promises less of chi-square."""


@dataclass(frozen=True, eq=False)
class DrawnData:
    """Data as they would be if the best fit were the truth, by seed.

    Parameters
    ----------
    fitted
        The best fit.
    dispersion
        s^2, by which misfit raises the variance of the noise.
    seed
        Seed of all draws.
    lasting
        Uncertainty of the data so far due to the apparatus.
    """

    fitted: FittedModel
    dispersion: float
    seed: int
    lasting: Lasting

    def refit(self, number: int, record: ForecastRecord | None) -> FloatArray:
        """Return the parameters fitted to a drawn data set, in distances of their limits.

        The data so far are drawn alike whatever is recorded besides.
        """
        likelihood, x0 = self.fitted.model.likelihood, self.fitted.fit.x
        here = likelihood.curves(x0)
        assert here is not None
        s = np.sqrt(self.dispersion)
        known = likelihood.prior.stated_slopes(likelihood.problem.span)
        J = self.lasting.whiten(self.fitted.fit.jacobian[: sum(likelihood.points)]) / s
        parts = [J, known, *([] if record is None else [record.jacobian / s])]
        begin = np.concatenate(parts)
        rng = np.random.default_rng(seed_for(self.seed, "worth", number))
        z, none = rng.standard_normal(len(begin)), np.empty(0)

        def residuals_all(X: FloatArray, led: bool = False) -> list[FloatArray]:
            curves = likelihood.curves_all(X, led)
            new = [none] * len(X) if record is None else record.whitened(likelihood, X, led)
            return [row(*one) for one in zip(X, curves, new, strict=True)]

        def row(x: FloatArray, curves: FloatArray | None, new: FloatArray | None) -> FloatArray:
            if curves is None or new is None:
                return np.full(len(begin), FAILED)
            white = self.lasting.whiten(likelihood.whiten(curves - here)) / s
            return np.concatenate([white, linear.product(known, x - x0), new / s]) - z

        def residuals(x: FloatArray) -> FloatArray:
            return residuals_all(x[None])[0]

        def jacobian(x: FloatArray, r: FloatArray) -> FloatArray:
            return derivatives(partial(residuals_all, led=True), x, r)[0]

        return minimise(residuals, jacobian, x0, ENOUGH, begin=begin).x


def spreads(
    drawn: DrawnData,
    records: Sequence[ForecastRecord | None],
    predictions: Mapping[str, Forecast],
    draws: int,
    cores: int,
) -> list[tuple[FloatArray, dict[str, float]]]:
    """Return the spread of parameters and predictions over refits, for each record.

    The first is in units of the search range, shape (parameters,); that of a prediction is the root
    mean square over its record.
    """
    jobs = [(record, number) for record in records for number in range(draws)]
    ends = parallel_map(lambda i: drawn.refit(jobs[i][1], jobs[i][0]), len(jobs), cores)
    likelihood = drawn.fitted.model.likelihood
    found = []
    for k in range(len(records)):
        X = np.array(ends[k * draws : (k + 1) * draws])
        spread = {}
        for name, one in predictions.items():
            curves = simulated_curves(likelihood, one.experiment, one.requests, X)
            finished = np.array([curve for curve in curves if curve is not None])
            spread[name] = float(np.sqrt(np.mean(np.var(finished, axis=0, ddof=1))))
        found.append((np.std(X, axis=0, ddof=1), spread))
    return found
