"""The restricted likelihood of many correlations for the same splines and series.

-2 log L = log det R + log det X^T R^-1 X + q, where q = r^T R^-1 r is the least sum of generalised
least squares. If the size of the noise is not known, (n - k) log(q/(n - k)) stands for q (Patterson
and Thompson 1971, doi 10.1093/biomet/58.3.545). All of it is in the small matrix Z^T R^-1 Z of
Z = [X y], for which no R is factorised:

- ar^k at lag k: (1 - ar^2) R^-1 = (1 + ar^2) I - ar (S + S^T) - ar^2 (e_1 e_1^T + e_n e_n^T), S the
  shift by one point.
- Two lags: R = I + r_1 K + r_2 (K^2 - 2 I) + r_2 (e_1 e_1^T + e_n e_n^T) with K = S + S^T. The
  sine transform makes K diagonal, 2 cos(pi i/(n + 1)); Woodbury's formula takes the ends in.
"""

import math

import numpy as np
from scipy.fft import dst

from pyrofit.estimate.correlation import Correlation
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

LEAST_SQUARES = 1e-30
"""Sum of squares at least; a series may lie on its curve exactly."""


class Restricted:
    """-2 log of the restricted likelihood of correlations, up to a constant.

    Parameters
    ----------
    X
        Splines, shape (n, k), over the size of the noise.
    y
        The series, shape (n,), over the same.
    known
        Whether that is the size of the noise itself, or only proportional to it.
    """

    def __init__(self, X: FloatArray, y: FloatArray, known: bool) -> None:
        n = len(y)
        self.rest, self.known = n - X.shape[1], known
        # The part of y that splines follow does not change the likelihood, but would cost digits.
        basis, _ = linear.qr(X)
        Z = np.column_stack([X, y - linear.product(basis, linear.product(basis.T, y))])
        self.ends = Z[[0, -1]]
        self.square = linear.gram(Z)
        shifted = linear.product(Z[1:].T, Z[:-1])
        self.shifted = shifted + shifted.T
        ends = np.zeros((n, 2))
        ends[0, 0] = ends[-1, 1] = 1.0
        self.waves = dst(np.column_stack([Z, ends]), type=1, norm="ortho", axis=0)
        self.eigenvalues = np.array(
            [2.0 * math.cos(math.pi * i / (n + 1)) for i in range(1, n + 1)]
        )

    def __call__(self, correlation: Correlation) -> float:
        """Return -2 log L of a correlation over up to two lags, or of ar^k at lag k."""
        ar = correlation.ar
        try:
            G, log_det = self._lasting(ar) if ar else self._lags(correlation)
            factor = linear.cholesky(G[:-1, :-1])
        except np.linalg.LinAlgError:
            return np.inf  # splines without a point
        part = linear.solve_lower(factor, G[:-1, -1])
        squares = max(float(G[-1, -1]) - linear.dot(part, part), LEAST_SQUARES)
        log_curve = 2.0 * float(functions.log(np.diag(factor)).sum())
        size = squares if self.known else self.rest * functions.log(squares / self.rest)
        return log_det + log_curve + size

    def _lasting(self, ar: float) -> tuple[FloatArray, float]:
        rest = 1.0 - ar**2
        middle = (1.0 + ar**2) * self.square - ar * self.shifted
        G = middle - ar**2 * linear.gram(self.ends)
        return G / rest, (len(self.eigenvalues) - 1) * float(functions.log(rest))

    def _lags(self, correlation: Correlation) -> tuple[FloatArray, float]:
        one, two = (*correlation.lags, 0.0, 0.0)[:2]
        density = 1.0 + one * self.eigenvalues + two * (self.eigenvalues**2 - 2.0)
        G = linear.product(self.waves.T, self.waves / density[:, None])
        inner, cross = G[:-2, :-2], G[:-2, -2:]
        ends = np.eye(2) + two * G[-2:, -2:]
        log_det = float(functions.log(density).sum()) + linear.log_det(ends)
        return inner - linear.product(two * cross, linear.solve(ends, cross.T)), log_det
