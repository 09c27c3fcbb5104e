"""By how much a further record narrows parameters and predictions, linear about the best fit.

Parameters are counted in distances of their limits. With the inverse covariance A that the data so
far leave, and the whitened derivatives J of the new record,

    C_0 = A^-1,    C_1 = (A + J^T J / s^2)^-1,    gain = log2(det C_0 / det C_1) / 2  [bit].

A prediction with derivatives P has the covariance P C P^T.
"""

import numpy as np

from pyrofit.solver.arrays import FloatArray


def narrowed(curvature: FloatArray, jacobian: FloatArray, dispersion: float) -> FloatArray:
    """Return the inverse covariance with a further record, shape (parameters, parameters).

    >>> narrowed(np.array([[1.0]]), np.array([[2.0], [2.0]]), 2.0)
    array([[5.]])
    """
    return np.asarray(curvature + jacobian.T @ jacobian / dispersion)


def sds(curvature: FloatArray) -> FloatArray:
    """Return the standard deviations of the parameters, shape (parameters,)."""
    return np.asarray(np.sqrt(np.diag(np.linalg.inv(curvature))))


def predicted_sd(curvature: FloatArray, slopes: FloatArray) -> float:
    """Return the standard deviation of a predicted curve, root mean square over its points.

    ``slopes`` are the derivatives of the curve, shape (points, parameters).

    >>> predicted_sd(np.diag([4.0, 1.0]), np.array([[2.0, 0.0], [0.0, 7.0]]))
    5.0
    """
    spread = slopes @ np.linalg.inv(np.linalg.cholesky(curvature)).T
    return float(np.sqrt(np.sum(spread**2) / len(slopes)))


def gain(before: FloatArray, after: FloatArray) -> float:
    """Return the information gained [bit].

    >>> gain(np.eye(2), np.diag([4.0, 1.0]))
    1.0
    """
    return float(0.5 * (np.linalg.slogdet(after)[1] - np.linalg.slogdet(before)[1]) / np.log(2.0))


def left(before: FloatArray, after: FloatArray) -> float:
    """Return the geometric mean of what is left of some standard deviations; 1 of none.

    >>> left(np.array([1.0, 2.0]), np.array([0.5, 1.0]))
    0.5
    """
    if before.size == 0:
        return 1.0
    return float(np.exp(np.mean(np.log(after / before))))
