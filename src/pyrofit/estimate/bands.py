"""Bands of predicted curves: parameters that vary, and model discrepancy."""

from collections.abc import Sequence

import numpy as np

from pyrofit.estimate.discrepancy import Discrepancy, factor_of, noise_covariance
from pyrofit.estimate.noise import NoiseModel
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

QUANTILES = (0.025, 0.5, 0.975)


def band(curves: FloatArray) -> FloatArray:
    """Return the 2.5, 50 and 97.5 % quantiles of curves: (sets, points) to (3, points)."""
    return np.asarray(np.quantile(curves, QUANTILES, axis=0))


def carried(found: Sequence[Discrepancy]) -> Discrepancy:
    """Return the discrepancy of a signal that was not fitted, from experiments where it was.

    Sizes are averaged in squares, how long they last as logarithms.

    >>> carried([Discrepancy(0.03, 0.0, 0.0, 0.1), Discrepancy(0.04, 0.0, 0.0, 0.4)]).lasting
    0.2
    """
    sizes = np.array([[of.level, of.time, of.offset] for of in found])
    level, time, offset = np.sqrt(np.mean(sizes**2, axis=0)).tolist()
    lasting = float(functions.exp(np.mean(functions.log([of.lasting for of in found]))))
    return Discrepancy(level, time, offset, round(lasting, 12))


def free(covariance: FloatArray, sets: int, rng: np.random.Generator) -> FloatArray:
    """Draw discrepancies that no measurement tells, shape (sets, points)."""
    factor = factor_of(covariance)
    return linear.product(rng.standard_normal((sets, len(factor))), factor.T)


def measured(
    covariance: FloatArray, noise: NoiseModel, residuals: FloatArray, rng: np.random.Generator
) -> FloatArray:
    """Draw discrepancies of a fitted series, given the residuals of each set's curve.

    Matheron's rule: with delta_0 of covariance D and e_0 of covariance N,
    delta = delta_0 + D (D + N)^-1 (r - delta_0 - e_0) has the distribution of delta given r.

    Parameters
    ----------
    covariance
        D, shape (points, points).
    noise
        Noise of the series.
    residuals
        r = measured - simulated, shape (sets, points).
    rng
        The random numbers.
    """
    N = noise_covariance(noise)
    drawn = free(covariance, len(residuals), rng)
    noisy = drawn + linear.product(rng.standard_normal(residuals.shape), linear.cholesky(N).T)
    gain = linear.solve(covariance + N, covariance)
    return np.asarray(drawn + linear.product(residuals - noisy, gain))
