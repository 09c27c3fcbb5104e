"""Banded factors of a covariance of equal neighbours, row by row."""

import math

import numpy as np

from pyrofit.numerics.functions import Floats


def cholesky(lags: tuple[float, ...], n: int) -> Floats:
    """Return L with L L^T = R, R of ones on the diagonal and ``lags`` beside it.

    Shape (n, lags + 1): row i holds L[i, i], L[i, i - 1] and so on; zeros stand for those outside.

    Raises
    ------
    numpy.linalg.LinAlgError
        The matrix is not positive definite.

    >>> cholesky((0.6,), 2).tolist()
    [[1.0, 0.0], [0.8, 0.6]]
    """
    count = len(lags)
    rows: list[list[float]] = []
    for i in range(n):
        row = [0.0] * (count + 1)
        for k in range(min(count, i), 0, -1):
            other = rows[i - k]
            shared = sum(row[k + m] * other[m] for m in range(1, count + 1 - k))
            row[k] = (lags[k - 1] - shared) / other[0]
        left = 1.0 - sum(value * value for value in row[1:])
        if not left > 0.0:
            raise np.linalg.LinAlgError("Matrix is not positive definite")
        row[0] = math.sqrt(left)
        rows.append(row)
    return np.array(rows).reshape(n, count + 1)


def solve_lower(factor: Floats, b: Floats) -> Floats:
    """Return x of L x = b for L of `cholesky`, b of shape (n,) or (n, k)."""
    from pyrofit.numerics.kernels import matrices

    x = matrices.solve_band(factor, np.ascontiguousarray(b.reshape(len(b), -1), dtype=np.float64))
    return np.asarray(x.reshape(b.shape))
