"""By how much a further record narrows parameters and predictions, linear about the best fit.

Parameters are counted in distances of their limits. With the inverse covariance A that the data so
far leave, and the whitened derivatives J of the new record,

    C_0 = A^-1,    C_1 = (A + J^T J / s^2)^-1,    gain = log2(det C_0 / det C_1) / 2  [bit].

A prediction with derivatives P has the covariance P C P^T.
"""

import math
from collections.abc import Sequence

import numpy as np

from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray


def narrowed(curvature: FloatArray, jacobian: FloatArray, dispersion: float) -> FloatArray:
    """Return the inverse covariance with a further record, shape (parameters, parameters).

    >>> narrowed(np.array([[1.0]]), np.array([[2.0], [2.0]]), 2.0)
    array([[5.]])
    """
    return np.asarray(curvature + linear.gram(jacobian) / dispersion)


def sds(curvature: FloatArray, free: Sequence[int]) -> FloatArray:
    """Return the standard deviations of the parameters, shape (parameters,).

    ``free`` are the positions of those that do not rest at a limit. Parameters at a limit stay
    there for the others. Their own numbers are computed as if they were free.

    >>> sds(np.array([[2.0, 1.0], [1.0, 1.0]]), [0, 1]).round(3).tolist()
    [1.0, 1.414]
    >>> sds(np.array([[4.0, 1.0], [1.0, 1.0]]), [0]).round(3).tolist()
    [0.5, 1.155]
    """
    found = np.empty(len(curvature))
    for i in range(len(curvature)):
        moving = sorted({*free, i})
        found[i] = np.sqrt(linear.inverse(_of(curvature, moving))[moving.index(i), moving.index(i)])
    return found


def predicted_sd(curvature: FloatArray, slopes: FloatArray, free: Sequence[int]) -> float:
    """Return the standard deviation of a predicted curve, root mean square over its points.

    ``slopes`` are the derivatives of the curve, shape (points, parameters).

    >>> predicted_sd(np.diag([4.0, 1.0]), np.array([[2.0, 0.0], [0.0, 7.0]]), [0, 1])
    5.0
    """
    root = linear.inverse_root(_of(curvature, free)).T
    return float(np.sqrt(np.sum(linear.product(slopes[:, list(free)], root) ** 2) / len(slopes)))


def gain(before: FloatArray, after: FloatArray, free: Sequence[int]) -> float:
    """Return the information gained [bit].

    >>> gain(np.eye(2), np.diag([4.0, 1.0]), [0, 1])
    1.0
    """
    new, old = (linear.log_det(_of(part, free)) for part in (after, before))
    return 0.5 * (new - old) / math.log(2.0)


def _of(curvature: FloatArray, moving: Sequence[int]) -> FloatArray:
    return curvature[np.ix_(list(moving), list(moving))]


def left(before: FloatArray, after: FloatArray) -> float:
    """Return the geometric mean ratio of standard deviations, after over before; 1 of none.

    >>> left(np.array([1.0, 2.0]), np.array([0.5, 1.0]))
    0.5
    """
    if before.size == 0:
        return 1.0
    return float(functions.exp(np.mean(functions.log(after / before))))
