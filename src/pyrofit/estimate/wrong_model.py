"""Covariance of the parameters of a model that misses its tests.

The parameters minimise chi-square with the noise N. If curves also deviate by a discrepancy of
covariance D, see `pyrofit.estimate.discrepancy`, they scatter more than that minimum tells (Huber
1967, the sandwich; White 1982, doi 10.2307/1912526). With J = d whitened residuals / d x, known
values K, and the whitened factor W of D = F F^T,

    C = H^-1 (J^T J + J^T W W^T J + K^T K + 12 I) H^-1,    H = J^T J + K^T K + 12 I.
"""

import numpy as np

from pyrofit.estimate.discrepancy import estimated, times
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.posterior import UNIFORM, Posterior
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

MOST_POINTS = 60
"""Points of a series from which its discrepancy is estimated; it lasts over many."""


def covariance_of_misfit(
    likelihood: Likelihood, posterior: Posterior, slopes: FloatArray, curves: FloatArray
) -> FloatArray:
    """Return C, shape (parameters, parameters).

    Parameters
    ----------
    likelihood
        With the noise alone.
    posterior
        Residuals and derivatives at the optimum.
    slopes, curves
        d curves / d x and the curves there, shapes (points, parameters) and (points,).
    """
    found = estimated(likelihood, posterior.x, slopes, curves, MOST_POINTS)
    parts = zip(found, times(likelihood), likelihood.split(curves), strict=True)
    factors = [of.factor(time, curve) for of, time, curve in parts]
    white = [noise.whiten(factor) for noise, factor in zip(likelihood.noise, factors, strict=True)]
    J = posterior.jacobian[: posterior.residuals.size]
    K = posterior.jacobian[posterior.residuals.size :]
    ahead = linear.gram(K) + UNIFORM * np.eye(posterior.x.size)
    middle = linear.gram(J) + ahead
    for W, part in zip(white, likelihood.split(J), strict=True):
        middle += linear.gram(linear.product(W.T, part))
    H = linear.gram(J) + ahead
    half = linear.solve(H, middle)
    return np.asarray(linear.solve(H, half.T))
