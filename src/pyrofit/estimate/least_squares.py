"""Multistart bounded least squares on the same cost, to see where SCE-UA stops short."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pyrofit.estimate.bounded_least_squares import minimise
from pyrofit.estimate.derivatives import derivatives
from pyrofit.estimate.posterior import limit_of
from pyrofit.estimate.problem import Problem, failed
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

GAIN = 1e-7
"""A descent ends where it promises to lower the sum of squares by less than this share."""
MOST_DESCENTS = 8


@dataclass(frozen=True)
class Start:
    """Where one start ended."""

    cost: float
    values: FloatArray
    calls: int
    at_bound: tuple[str, ...]


def multistart(problem: Problem, starts: int, seed: int) -> list[Start]:
    """Minimise the residuals of a cost from random starts; best first.

    By the descents of `bounded_least_squares`, on parameters scaled to [0, 1] by their limits.

    Parameters
    ----------
    problem
        The cost to minimise.
    starts
        Number of starts, drawn uniformly within the limits.
    seed
        Seed of the draws.

    Returns
    -------
    list of Start
        Sorted by cost. The cost is the problem's; with several terms the minimised sum of squares
        is not the same function.
    """
    rng = np.random.default_rng(seed)
    draws = rng.uniform(0.05, 0.95, size=(starts, len(problem.names)))
    span = problem.upper - problem.lower
    ends = (descend(problem, problem.lower + u * span) for u in draws)
    return sorted(ends, key=lambda s: s.cost)


def descend(problem: Problem, values: FloatArray) -> Start:
    """Minimise the residuals of a cost from given values, shape (parameters,), SI units.

    The end is a local minimum, as far as the difference quotients tell.
    """
    span = problem.upper - problem.lower
    u = np.clip((values - problem.lower) / span, 0.0, 1.0)
    known: dict[bytes, FloatArray] = {}
    calls = 0

    def residuals(v: FloatArray) -> FloatArray:
        nonlocal calls
        if v.tobytes() not in known:
            calls += 1
            known[v.tobytes()] = problem.residuals(problem.lower + v * span)
        return known[v.tobytes()]

    def beside(V: FloatArray) -> list[FloatArray | None]:
        nonlocal calls
        calls += len(V)
        there = problem.residuals_all(problem.lower + V * span, led=True)
        return [None if failed(r) else r for r in there]

    def slopes(v: FloatArray, r: FloatArray) -> FloatArray:
        return derivatives(beside, v, r, problem.difference)[0]

    found = _minimum(residuals, slopes, u)
    end = problem.lower + found * span
    return Start(
        cost=problem.evaluate(end).cost,
        values=end,
        calls=calls + 1,
        at_bound=at_limits(problem, found),
    )


def _minimum(
    residuals: Callable[[FloatArray], FloatArray],
    slopes: Callable[[FloatArray, FloatArray], FloatArray],
    u: FloatArray,
) -> FloatArray:
    """Return where descents end whose gain is `GAIN` of the sum of squares that is left."""
    left = linear.dot(residuals(u), residuals(u))
    for _ in range(MOST_DESCENTS):
        found = minimise(residuals, slopes, u, GAIN * left, ridge=1e-12)
        u = found.x
        if found.chi2 > 0.5 * left or found.chi2 == 0.0:
            break
        left = found.chi2
    return u


def at_limits(problem: Problem, u: FloatArray) -> tuple[str, ...]:
    """Return the names of the parameters at a limit, values scaled to [0, 1] by the limits."""
    return tuple(n for n, x in zip(problem.names, u, strict=True) if limit_of(x))
