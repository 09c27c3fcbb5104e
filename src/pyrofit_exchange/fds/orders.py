"""A reaction of order n as a sum of reactions of first order, which no version reads otherwise."""

import math
from functools import cache

import numpy as np

from pyrofit.estimate.quadratic import least_within
from pyrofit.numerics import fitting, functions, linear
from pyrofit.solver.arrays import FloatArray

REACHED = 1e-4
"""Unreacted share up to which the sum is fitted."""


@cache
def first_order_sum(order: float) -> tuple[tuple[float, float], ...]:
    """Return mass fractions and relative rates of first-order parts that lose mass like order n.

    m/m0(tau) = sum_k w_k exp(-a_k tau), 4 parts up to n = 1.5, 5 up to 2, 6 above; the largest
    difference is about 4e-4. For n > 1 the exact curve is a mixture of exponentials with a gamma
    distribution of rates, so that the sum converges.

    Returns
    -------
    Pairs of w_k [-] and a_k [-], the fastest first.

    Examples
    --------
    >>> len(first_order_sum(1.4)), round(sum(w for w, _ in first_order_sum(1.4)), 12)
    (4, 1.0)
    """
    parts = 4 if order <= 1.5 else 5 if order <= 2.0 else 6
    left = np.concatenate([np.linspace(0.999, 0.02, 200), functions.geometric(0.02, REACHED, 60)])
    tau = (functions.power(left, 1.0 - order) - 1.0) / (order - 1.0)
    shape = 1.0 / (order - 1.0)
    start = functions.log(functions.geometric(2.0 + 1.0 / shape, 0.02 + 0.3 * (shape > 1.0), parts))

    def fitted(logs: FloatArray) -> tuple[FloatArray, FloatArray]:
        matrix = functions.exp(-functions.exp(logs)[None, :] * tau[:, None])
        square = linear.gram(matrix) + 1e6
        pull = linear.product(matrix.T, left) + 1e6
        weights = least_within(square, -pull, np.zeros(parts), np.full(parts, np.inf))
        return weights, linear.product(matrix, weights) - left

    logs = fitting.least_squares(lambda logs: fitted(logs)[1], start, gain=1e-15)
    weights, _ = fitted(logs)
    pairs = sorted(
        zip(weights / weights.sum(), functions.exp(logs), strict=True), key=lambda p: -p[1]
    )
    return tuple((float(w), float(a)) for w, a in pairs if w > 0.0)


def same_half_time(order: float) -> float:
    """Return the factor on A with which first order reaches one half as early as order n.

    >>> round(same_half_time(1.0), 12), round(same_half_time(2.0), 4)
    (1.0, 0.6931)
    """
    if abs(order - 1.0) < 1e-9:
        return 1.0
    half: float = (1.0 - 0.5 ** (1.0 - order)) / (1.0 - order)
    return math.log(2.0) / half
