"""The least value of a quadratic function within limits."""

import numpy as np

from pyrofit.solver.arrays import FloatArray


def least_within(
    square: FloatArray, slope: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Return x of least x^T B x / 2 + g^T x within limits, B symmetric positive definite.

    Active sets as of Stark and Parker (1995, Comput. Stat. 10, 129), compiled: a descent asks for
    many, and arrays of NumPy take fifty times as long and more.

    Parameters
    ----------
    square, slope
        B of shape (n, n) and g of shape (n,).
    low, high
        Limits of x, shape (n,); they may be infinite.

    Raises
    ------
    numpy.linalg.LinAlgError
        B is not positive definite.

    >>> least_within(np.eye(2), -np.ones(2), np.zeros(2), np.array([0.5, 5.0])).tolist()
    [0.5, 1.0]
    """
    from pyrofit.numerics.kernels.quadratic import least_within as compiled

    x, definite = compiled(*map(np.ascontiguousarray, (square, slope, low, high)))
    if not definite:
        raise np.linalg.LinAlgError("Matrix is not positive definite")
    return np.asarray(x)
