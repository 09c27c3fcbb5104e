"""The whitening of common errors, by a root of a small matrix instead of singular values.

With V of shape (n, k), I + V^T V = C C^T, B = V C^-T and D = C^-1 C^-T,

    W = (I + V V^T)^(-1/2) = (I - B B^T)^(1/2) = I - B F B^T,    F = (I + D^(1/2))^-1,

where B, D and F are at most 1. W is exact to the rounding of 1 + |V|^2, and to some 1e-13 where V
does not reach. With P^T D P = T, a tridiagonal matrix of Householder's
reflections,

    F = (2/pi) int_0^inf (D + t^2 I)^-1 t^2/(1 + t^2) dt
      = P [(2/pi) int (T + e^(2u) I)^-1 e^(2u)/(e^u + e^-u) du] P^T.

The trapezoidal rule over u takes all matrices side by side. Its error is e^(-pi^2/h) of the step h.
"""

import math

import numpy as np

from pyrofit.numerics import functions, linear
from pyrofit.numerics.functions import Floats

_STEP = 0.27
_FROM, _TO = -88, 72
"""Steps of u. Below, e^(3u) is less than 1e-31; above, e^(2u) + 1 is e^(2u) when rounded."""


def whitening(V: Floats) -> tuple[Floats, Floats]:
    """Return B and F, of shapes (n, k) and (k, k), of (I + V V^T)^(-1/2) = I - B F B^T.

    >>> B, F = whitening(np.array([[0.0], [3.0**0.5]]))
    >>> (np.eye(2) - B @ F @ B.T).round(12).tolist()
    [[1.0, 0.0], [0.0, 0.5]]
    """
    if V.shape[0] < V.shape[1]:
        V = linear.qr(V.T)[1].T  # of the same V V^T
    inverse = linear.inverse_root(np.eye(V.shape[1]) + linear.gram(V))
    return linear.product(V, inverse.T), _of_root(linear.gram(inverse.T))


def _of_root(square: Floats) -> Floats:
    """Return F = (I + D^(1/2))^-1 of a symmetric positive definite D, none of it above 1."""
    u = _STEP * np.arange(_FROM, _TO + 1.0)
    ahead = functions.exp(u)
    weights = (2.0 * _STEP / math.pi) * ahead**2 / (ahead + 1.0 / ahead)
    weights[-1] /= 1.0 - float(functions.exp(-_STEP))  # D does not count in those above
    diagonal, beside, mirrors = _tridiagonal(square)
    found = _sum_of_inverses(diagonal, beside, ahead**2, weights)
    for k, v in reversed(mirrors):
        for turned in (found, found.T):
            turned[k:] -= np.multiply.outer(2.0 * v, linear.product(v, turned[k:]))
    return np.asarray(0.5 * (found + found.T))


def _tridiagonal(a: Floats) -> tuple[Floats, Floats, list[tuple[int, Floats]]]:
    """Return diagonal, numbers beside it, and the reflections I - 2 v v^T of rows k and on."""
    rest = np.array(a, dtype=np.float64)
    mirrors = []
    for k in range(1, len(rest) - 1):
        v = rest[k:, k - 1].copy()
        largest = float(np.max(np.abs(v)))
        if largest == 0.0:
            continue
        v /= largest
        size = linear.norm(v)
        end = -math.copysign(size, v[0])
        v[0] -= end
        v /= linear.norm(v)
        rest[k, k - 1] = end * largest
        p = 2.0 * linear.product(rest[k:, k:], v)
        w = p - linear.dot(v, p) * v
        rest[k:, k:] -= np.multiply.outer(v, w) + np.multiply.outer(w, v)
        mirrors.append((k, v))
    return np.diag(rest).copy(), np.diag(rest, -1).copy(), mirrors


def _sum_of_inverses(diagonal: Floats, beside: Floats, shifts: Floats, weights: Floats) -> Floats:
    """Return sum_j w_j (T + s_j I)^-1 of a tridiagonal matrix, shape (n, n).

    Pivots d_i from above and c_i from below give the inverse: 1/(d_i + c_i - T_ii - s) on its
    diagonal, and from column k to the one before the factor -T_(i, i-1)/d_(i-1) (Meurant 1992, doi
    10.1137/0613045).
    """
    n = diagonal.size
    own = diagonal[:, None] + shifts
    above, below = own.copy(), own.copy()
    for i in range(1, n):
        above[i] -= beside[i - 1] ** 2 / above[i - 1]
        below[-1 - i] -= beside[-i] ** 2 / below[-i]
    inside = weights / (above + below - own)
    found = np.zeros((n, n))
    path = np.zeros((n, shifts.size))
    for i in range(n):
        if i:
            path[:i] *= -beside[i - 1] / above[i - 1]
        path[i] = 1.0
        found[i, : i + 1] = linear.product(path[: i + 1], inside[i])
    return found + np.tril(found, -1).T
