"""The product of an effect's parameters that the data determine where they leave each one open.

A layer of char resists heat by its thickness over its conductivity. A curve determines that ratio.
It does not determine yield, density and conductivity, from which the ratio follows. With C the
covariance of the parameters p, R_ij = C_ij/(p_i p_j) is that of their logarithms. The eigenvector a
of its least eigenvalue says which product of powers, p_1^a_1 p_2^a_2 ..., is known best. Its
relative standard deviation is sqrt(a^T R a).
"""

import math
from collections.abc import Sequence

import numpy as np

from pyrofit.numerics import linear
from pyrofit.results.diagnosis_candidates import OfRidge
from pyrofit.solver.arrays import FloatArray


def ridge_of(
    effect: str,
    names: Sequence[str],
    values: FloatArray,
    covariance: FloatArray,
    open_sd: float,
    least_gain: float,
) -> OfRidge | None:
    """Return the best known product of an effect's parameters, None where each one is known.

    Only positive parameters with a relative standard deviation of ``open_sd`` or more take part.
    The product must be known ``least_gain`` times better than the first of them. The power of the
    strength is 1, or else the largest one.

    Parameters
    ----------
    names
        Parameters, the strength first.
    values, covariance
        Their values and covariance, one unit each.
    """
    sd = np.sqrt(np.diag(covariance))
    left_open = [i for i, p in enumerate(values) if p > 0.0 and sd[i] >= open_sd * p]
    if len(left_open) < 2:
        return None
    p = values[left_open]
    R = covariance[np.ix_(left_open, left_open)] / np.outer(p, p)
    a = linear.eigen(R)[1][:, 0]
    unit = 0 if abs(a[0]) >= 0.1 * np.abs(a).max() else int(np.argmax(np.abs(a)))
    a = np.round(a / a[unit], 1)
    product = math.sqrt(max(linear.dot(a, linear.product(R, a)), 0.0))
    alone = np.sqrt(np.diag(R))
    if np.count_nonzero(a) < 2 or least_gain * product > alone[unit]:
        return None
    parts = [(names[i], float(b), float(s)) for i, b, s in zip(left_open, a, alone, strict=True)]
    return OfRidge(
        effect=effect,
        exponents={name: power for name, power, _ in parts if power},
        relative_sd=product,
        alone={name: own for name, power, own in parts if power},
    )
