"""Derivatives of residuals and curves by differences, within limits and beside failed runs."""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pyrofit.solver.arrays import FloatArray

Curves = Callable[[FloatArray], Sequence[FloatArray | None]]
"""From sets, shape (sets, parameters), to a curve of each; None where a run does not finish. The
first set leads, see `pyrofit.simulate.simulate_slabs`."""


class Difference(NamedTuple):
    """How a derivative is taken."""

    points: tuple[tuple[int, ...], ...]
    """Points beside x in steps towards the farther limit. The next choice serves where one does not
    fit between the limits or a run does not finish."""
    step: float
    """Distance of the points, as a fraction of the search range."""


SECANT = Difference(((1,), (-1,)), 1e-6)
"""Of first order. Led runs differ smoothly, so the step can be small: with 1e-7 to 1e-5 derivatives
of measured slabs change by 0.2 % of their norms at most. Parameters that nearly do the same need
that. Over 1e-4 the bend of the curves halved the standard deviations of such a twin."""
PARABOLA = Difference(((1, -1), (1, 2), (-1, -2)), 1e-3)
"""Of second order: its wider step suits programs that round their curves or choose their steps."""
LEAST = 0.1
"""Two points nearer to each other than this share of a step are one: rounding would show."""


def derivatives(
    curves: Curves,
    x: FloatArray,
    here: FloatArray,
    how: Difference = SECANT,
    by: Sequence[int] | None = None,
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return d curve / d x, and which derivatives were found; the others are zero.

    The first set of ``curves`` is x, whose cells and time steps the others take. With steps of
    their own, the difference of two curves would hold the change of the solver's error, and be
    divided by a small distance (Bock 1981, doi 10.1007/978-3-642-68220-9_8).

    By one point it is the slope of the secant through x and that, by two that of the parabola. This
    is the central difference inside the limits, and the one-sided one at a limit. With the
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
    how
        Points and step.
    by
        Positions of the parameters, all by default; the other derivatives are zero.

    Returns
    -------
    tuple of arrays
        Shapes (points, parameters) and (parameters,).

    >>> x = np.array([0.25])
    >>> for how in (SECANT, PARABOLA):
    ...     print(derivatives(lambda X: [x**2 for x in X], x, x**2, how._replace(step=0.125))[0])
    [[0.625]]
    [[0.5]]
    """
    J, found = np.zeros((here.size, x.size)), np.zeros(x.size, bool)
    wanted = np.arange(x.size) if by is None else np.unique(by)
    choices = {i: iter(_choices(x[i], how)) for i in wanted.tolist()}
    while places := {i: points for i, rest in choices.items() if (points := next(rest, None))}:
        sets = [_with(x, i, point) for i, points in places.items() for point in points]
        there = iter(curves(np.array([x, *sets]))[1:])
        for i, points in places.items():
            ends = [next(there) for _ in points]
            changes = [end - here for end in ends if end is not None]
            if len(changes) == len(points):
                J[:, i] = _slope([point - x[i] for point in points], changes)
                found[i] = True
        choices = {i: choices[i] for i in places if not found[i]}
    return J, found


def _choices(x: float, how: Difference) -> Iterator[list[float]]:
    """Yield the points of each choice that fit between the limits."""
    towards = how.step if x < 0.5 else -how.step
    for choice in how.points:
        points = [min(max(x + by * towards, 0.0), 1.0) for by in choice]
        if np.all(np.diff(np.sort([x, *points])) >= LEAST * how.step):
            yield points


def _with(x: FloatArray, i: int, value: float) -> FloatArray:
    there = x.copy()
    there[i] = value
    return there


def _slope(h: Sequence[float], d: Sequence[FloatArray]) -> FloatArray:
    if len(h) == 1:
        return d[0] / h[0]
    return (d[0] * (h[1] / h[0]) - d[1] * (h[0] / h[1])) / (h[1] - h[0])
