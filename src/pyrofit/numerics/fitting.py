"""Least squares, polynomials, and searches without derivatives, in an order that is fixed."""

from collections.abc import Callable

import numpy as np

from pyrofit.numerics import linear
from pyrofit.numerics.functions import Floats

_MOST_STEPS = 100
_MOST_REFUSED = 15
_DIFFERENCE = 6e-6
"""Step of a difference quotient, the cube root of the rounding of numbers."""


def least_squares(
    residuals: Callable[[Floats], Floats], start: Floats, gain: float = 1e-12
) -> Floats:
    """Return x of the least sum of squares of residuals, by Levenberg and Marquardt.

    Derivatives are central difference quotients. The descent ends where a step lowers the sum by
    less than the share ``gain``.
    """
    x, damping = np.array(start, dtype=np.float64), 1e-3
    r = residuals(x)
    for _ in range(_MOST_STEPS):
        J = _slopes(residuals, x)
        bend, slope = linear.gram(J), linear.product(J.T, r)
        square = linear.dot(r, r)
        for _ in range(_MOST_REFUSED):
            raised = bend + np.diag(damping * np.diag(bend) + 1e-300 + 1e-14 * bend.max())
            ahead = x - linear.solve(raised, slope)
            there = residuals(ahead)
            gained = square - linear.dot(there, there)
            if gained > 0.0:
                break
            damping *= 10.0
        else:
            return x
        x, r, damping = ahead, there, max(0.1 * damping, 1e-12)
        if gained <= gain * square:
            break
    return x


def _slopes(residuals: Callable[[Floats], Floats], x: Floats) -> Floats:
    columns = []
    for i, value in enumerate(x):
        step = np.zeros(x.size)
        step[i] = _DIFFERENCE * max(1.0, abs(float(value)))
        columns.append((residuals(x + step) - residuals(x - step)) / (2.0 * step[i]))
    return np.column_stack(columns)


def nelder_mead(
    function: Callable[[Floats], float],
    simplex: Floats,
    near: float,
    like: float,
    most_calls: int = 10_000,
) -> Floats:
    """Return x of the least value of a function, by Nelder and Mead (1965).

    As `scipy.optimize.minimize` does; but of equal values the older one is the better one.

    Parameters
    ----------
    function
        Of x, shape (n,).
    simplex
        Corners to begin with, shape (n + 1, n).
    near, like
        The search ends where all corners differ from the best one by no more than ``near``, and
        their values by no more than ``like``.
    most_calls
        It ends as well after so many calls.
    """
    corners = np.array(simplex, dtype=np.float64)
    values = np.array([function(corner) for corner in corners])
    calls = len(values)
    while True:
        order = np.argsort(values, kind="stable")
        corners, values = corners[order], values[order]
        wide = float(np.max(np.abs(corners[1:] - corners[0])))
        if calls >= most_calls or (wide <= near and not np.any(values[1:] > values[0] + like)):
            return np.asarray(corners[0])
        middle = corners[:-1].mean(axis=0)
        away = middle - corners[-1]
        found, value, used = _moved(function, middle, away, values)
        calls += used
        if value < values[-1]:
            corners[-1], values[-1] = found, value
            continue
        corners[1:] = corners[0] + 0.5 * (corners[1:] - corners[0])
        values[1:] = [function(corner) for corner in corners[1:]]
        calls += len(corners) - 1


def _moved(
    function: Callable[[Floats], float], middle: Floats, away: Floats, values: Floats
) -> tuple[Floats, float, int]:
    """Return the corner that replaces the worst one, its value and the calls used."""
    first = middle + away
    value = function(first)
    if values[0] <= value < values[-2]:
        return first, value, 1
    share = 2.0 if value < values[0] else 0.5 if value < values[-1] else -0.5
    second = middle + share * away
    other = function(second)
    if share == 2.0 and other >= value:
        return first, value, 2
    if share == 0.5 and other > value:
        return second, np.inf, 2
    return second, other, 2


def polynomial(x: Floats, y: Floats, degree: int) -> Floats:
    """Return the coefficients of the polynomial of least squares, the highest power first.

    >>> polynomial(np.array([0.0, 1.0, 2.0]), np.array([1.0, 3.0, 5.0]), 1).round(12).tolist()
    [2.0, 1.0]
    """
    columns = [np.ones(len(x))]
    for _ in range(degree):
        columns.insert(0, columns[0] * x)
    matrix = np.column_stack(columns)
    size = np.sqrt(np.sum(matrix**2, axis=0))
    return np.asarray(linear.least_squares(matrix / size, np.asarray(y)) / size)
