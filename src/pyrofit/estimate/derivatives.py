"""Derivatives of residuals and curves by differences, within limits and beside failed runs."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from pyrofit.solver.arrays import FloatArray

Curves = Callable[[FloatArray], Sequence[FloatArray | None]]
"""From sets, shape (sets, parameters), to a curve of each; None where a run does not finish."""

POINTS = {1: ((1,), (-1,)), 2: ((1, -1), (1, 2), (-1, -2))}
"""By order, the points beside x in steps towards the farther limit. The next choice serves where
one does not fit between the limits or a run does not finish."""
STEPS = {1: 3e-3, 2: 1e-3}
"""By order, the distance of the points, as a fraction of the search range. Of second order, no
standard deviation changes by 0.3 % from 1e-4 to 5e-3: neither solver noise nor curvature shows."""
LEAST = 0.1
"""Two points nearer to each other than this share of a step are one: rounding would show."""


def derivatives(
    curves: Curves,
    x: FloatArray,
    here: FloatArray,
    order: int,
    *,
    step: float | None = None,
    by: Sequence[int] | None = None,
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return d curve / d x, and which derivatives were found; the others are zero.

    Order 1 is the secant through x and one point. Order 2 is the slope of the parabola through x
    and two points: the central difference inside the limits, the one-sided one at a limit. With the
    distances h and the differences d of the curve at these points,

        d_1 / h_1,    (d_1 h_2 / h_1 - d_2 h_1 / h_2) / (h_2 - h_1).

    Parameters
    ----------
    curves
        Simulates several sets at once.
    x
        Parameters as fractions of the search range, shape (parameters,).
    here
        The curve at x, shape (points,).
    order
        1 or 2.
    step
        Distance of the points, as a fraction of the search range; default `STEPS`.
    by
        Positions of the parameters, all by default; the other derivatives are zero.

    Returns
    -------
    tuple of arrays
        Shapes (points, parameters) and (parameters,).

    >>> x = np.array([0.25])
    >>> for order in (1, 2):
    ...     print(derivatives(lambda X: [x**2 for x in X], x, x**2, order, step=0.125)[0])
    [[0.625]]
    [[0.5]]
    """
    step = STEPS[order] if step is None else step
    J, found = np.zeros((here.size, x.size)), np.zeros(x.size, bool)
    wanted = np.arange(x.size) if by is None else np.unique(by)
    choices = {i: iter(_choices(x[i], order, step)) for i in wanted.tolist()}
    while places := {i: points for i, rest in choices.items() if (points := next(rest, None))}:
        sets = [_with(x, i, point) for i, points in places.items() for point in points]
        there = iter(curves(np.array(sets)))
        for i, points in places.items():
            ends = [next(there) for _ in points]
            changes = [end - here for end in ends if end is not None]
            if len(changes) == len(points):
                J[:, i] = _slope([point - x[i] for point in points], changes)
                found[i] = True
        choices = {i: choices[i] for i in places if not found[i]}
    return J, found


def _choices(x: float, order: int, step: float) -> Iterator[list[float]]:
    """Yield the points of each choice that fit between the limits."""
    towards = step if x < 0.5 else -step
    for choice in POINTS[order]:
        points = [min(max(x + by * towards, 0.0), 1.0) for by in choice]
        if np.all(np.diff(np.sort([x, *points])) >= LEAST * step):
            yield points


def _with(x: FloatArray, i: int, value: float) -> FloatArray:
    there = x.copy()
    there[i] = value
    return there


def _slope(h: Sequence[float], d: Sequence[FloatArray]) -> FloatArray:
    if len(h) == 1:
        return d[0] / h[0]
    return (d[0] * (h[1] / h[0]) - d[1] * (h[0] / h[1])) / (h[1] - h[0])
