"""The restricted likelihood of many correlations for the same splines and series.

-2 log L = log det R + log det X^T R^-1 X + q, where q = r^T R^-1 r is the least sum of generalised
least squares. If the size of the noise is not known, (n - k) log(q/(n - k)) stands for q (Patterson
and Thompson 1971, doi 10.1093/biomet/58.3.545). All of it is in the small matrix Z^T R^-1 Z of
Z = [X y], for which no R is factorised:

- ar^k at lag k: (1 - ar^2) R^-1 = (1 + ar^2) I - ar (S + S^T) - ar^2 (e_1 e_1^T + e_n e_n^T), S the
  shift by one point.
- Two lags: R = I + r_1 K + r_2 (K^2 - 2 I) + r_2 (e_1 e_1^T + e_n e_n^T) with K = S + S^T. The
  sine transform makes K diagonal, 2 cos(pi i/(n + 1)); Woodbury's formula takes the ends in.

Two lags cost much, and are worth a search only where they may win. A bound tells that: let r be the
residual of least squares, and the columns of V be orthonormal, orthogonal to the splines, and
r/|r| the first of them. Then q >= |r|^2 [(V^T R V)^-1]_11 for every R (Schwarz). V is of Lanczos'
method for K, and V^T R V is linear in r_1 and r_2.
"""

import math
from functools import cached_property, lru_cache

import numpy as np
from scipy.fft import dst

from pyrofit.estimate.correlation import Correlation
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

LEAST_SQUARES = 1e-30
"""Sum of squares at least; a series may lie on its curve exactly."""
_DIRECTIONS = 8
"""Columns of V."""
_BLOCK = 64
"""Densities whose product is taken before its logarithm."""


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
        self._basis, _ = linear.qr(X)
        self._Z = np.column_stack([X, self._apart(y)])
        self.ends = self._Z[[0, -1]]
        self.square = linear.gram(self._Z)
        shifted = linear.product(self._Z[1:].T, self._Z[:-1])
        self.shifted = shifted + shifted.T
        self.eigenvalues = _eigenvalues(n)

    def __call__(self, correlation: Correlation) -> float:
        """Return -2 log L of a correlation over up to two lags, or of ar^k at lag k."""
        log_det, log_curve, squares = self.parts(correlation)
        return log_det + log_curve + self._misfit(squares, self.rest)

    def parts(self, correlation: Correlation) -> tuple[float, float, float]:
        """Return log det R, log det X^T R^-1 X and q; infinite where a spline has no point."""
        ar = correlation.ar
        try:
            if ar:
                G, log_det = self._lasting(ar)
            else:
                G, log_det = self._lags(correlation) if correlation.lags else (self.square, 0.0)
            factor = linear.cholesky(G[:-1, :-1])
        except np.linalg.LinAlgError:
            return np.inf, np.inf, np.inf
        part = linear.solve_lower(factor, G[:-1, -1])
        squares = max(float(G[-1, -1]) - linear.dot(part, part), LEAST_SQUARES)
        return log_det, 2.0 * float(functions.log(np.diag(factor)).sum()), squares

    def bound(self, correlation: Correlation) -> float:
        """Return a number that log det R + q of a correlation over two lags is not below.

        If the size of the noise is not known, n log(q/n) stands for q.
        """
        one, two = (*correlation.lags, 0.0, 0.0)[:2]
        size, first, second = self._directions
        inside = np.eye(len(first)) + one * first + two * second
        try:
            last = float(linear.cholesky(inside)[-1, -1])
        except np.linalg.LinAlgError:
            return -np.inf
        squares = max(size / last**2, LEAST_SQUARES)
        return self._log_det(one, two) + self._misfit(squares, len(self._Z))

    def _misfit(self, squares: float, points: int) -> float:
        return squares if self.known else points * float(functions.log(squares / points))

    def _apart(self, y: FloatArray) -> FloatArray:
        """Return the part of a series that no splines follow."""
        return np.asarray(y - linear.product(self._basis, linear.product(self._basis.T, y)))

    @cached_property
    def _directions(self) -> tuple[float, FloatArray, FloatArray]:
        """Return |r|^2, V^T K V, and V^T (K^2 - 2 I) V with the ends, the columns of V reversed."""
        r = self._Z[:, -1]
        size = max(linear.dot(r, r), LEAST_SQUARES)
        columns, moved = [r / math.sqrt(size)], []
        while True:
            moved.append(_neighbours(columns[-1]))
            if len(moved) == _DIRECTIONS:
                break
            ahead = self._apart(moved[-1])
            for column in columns:
                ahead = ahead - linear.dot(column, ahead) * column
            length = linear.norm(ahead)
            if length < 1e-6:
                break
            columns.append(ahead / length)
        V, KV = np.column_stack(columns[::-1]), np.column_stack(moved[::-1])
        square = linear.gram(KV) - 2.0 * np.eye(len(moved)) + linear.gram(V[[0, -1]])
        return size, linear.product(V.T, KV), square

    def _log_det(self, one: float, two: float) -> float:
        """Return log det R of two lags, the ends being sines of the transform."""
        n, waves = len(self._Z), self.eigenvalues
        density = np.ones(-(-n // _BLOCK) * _BLOCK)
        density[:n] = 1.0 + one * waves + two * (waves**2 - 2.0)
        blocks: FloatArray = np.multiply.reduce(density.reshape(_BLOCK, -1), axis=0)
        ends = (4.0 - waves**2) / density[:n] * (two / (n + 1))
        sides = (1.0 + float(ends[::2].sum())) * (1.0 + float(ends[1::2].sum()))
        return float(functions.log(blocks).sum()) + float(functions.log(sides))

    @cached_property
    def _waves(self) -> FloatArray:
        """Sine transform of Z and of the two ends."""
        ends = np.zeros((len(self._Z), 2))
        ends[0, 0] = ends[-1, 1] = 1.0
        return np.asarray(dst(np.column_stack([self._Z, ends]), type=1, norm="ortho", axis=0))

    def _lasting(self, ar: float) -> tuple[FloatArray, float]:
        rest = 1.0 - ar**2
        middle = (1.0 + ar**2) * self.square - ar * self.shifted
        G = middle - ar**2 * linear.gram(self.ends)
        return G / rest, (len(self.eigenvalues) - 1) * float(functions.log(rest))

    def _lags(self, correlation: Correlation) -> tuple[FloatArray, float]:
        one, two = (*correlation.lags, 0.0, 0.0)[:2]
        density = 1.0 + one * self.eigenvalues + two * (self.eigenvalues**2 - 2.0)
        G = linear.product(self._waves.T, self._waves / density[:, None])
        inner, cross = G[:-2, :-2], G[:-2, -2:]
        ends = np.eye(2) + two * G[-2:, -2:]
        log_det = float(functions.log(density).sum()) + linear.log_det(ends)
        return inner - linear.product(two * cross, linear.solve(ends, cross.T)), log_det


@lru_cache(maxsize=8)
def _eigenvalues(n: int) -> FloatArray:
    return np.array([2.0 * math.cos(math.pi * i / (n + 1)) for i in range(1, n + 1)])


def _neighbours(v: FloatArray) -> FloatArray:
    """Return K v: the sum of both neighbours of each point."""
    total = np.zeros_like(v)
    total[1:] = v[:-1]
    total[:-1] += v[1:]
    return total
