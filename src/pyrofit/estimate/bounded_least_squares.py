"""Least squares from a start: Levenberg and Marquardt with Broyden's updates, within limits.

Marquardt (1963, doi 10.1137/0111030); Broyden (1965, doi 10.1090/S0025-5718-1965-0198670-6). A
step costs one simulation instead of one per parameter; the derivatives are made anew where the
updated ones lead nowhere.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pyrofit.solver.arrays import FloatArray

MOST_STEPS = 80
"""Steps at most."""
MOST_REFUSED = 8
"""Refused steps in a row, each with ten times the damping, before a descent ends."""
RIDGE = 1e-6
"""Added to the curvature, so that a parameter without influence does not move."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Where a descent ended: chi-square, x, whitened residuals and their derivatives there.

    chi2 counts what is known; ``jacobian`` has shape (points + known, parameters) and is exact at x
    only where it is ``fresh``.
    """

    chi2: float
    x: FloatArray
    residuals: FloatArray
    jacobian: FloatArray
    fresh: bool = True


def minimise(
    residuals: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray, FloatArray], FloatArray],
    x: FloatArray,
    converged_gain: float,
    *,
    begin: FloatArray | None = None,
    fixed: int | None = None,
    most_steps: int = MOST_STEPS,
    most_refused: int = MOST_REFUSED,
    ridge: float = RIDGE,
) -> Fit:
    """Minimise the sum of squares of residuals over x in [0, 1].

    Parameters
    ----------
    residuals
        r(x), shape (rows,).
    jacobian
        From x and r(x) to d r / d x, shape (rows, parameters), a new array.
    x
        Start, shape (parameters,); it is brought within the limits.
    converged_gain
        The descent ends where fresh derivatives promise a smaller fall of the sum.
    begin
        Derivatives to begin with, if some are at hand.
    fixed
        Position of a parameter that keeps its value.
    most_steps, most_refused, ridge
        As the constants of this module say.
    """
    x = np.clip(x, 0.0, 1.0)
    r = residuals(x)
    fresh = begin is None
    held = [] if fixed is None else [fixed]
    J = _without(held, jacobian(x, r)) if begin is None else begin
    damping, refused = 1e-3, 0
    for _ in range(most_steps):
        step, promised = _step(J, r, x, damping, ridge)
        step[held] = 0.0
        gained = -1.0
        if promised > converged_gain:
            ahead = np.clip(x + step, 0.0, 1.0)  # a rate rounded below zero is no rate
            there = residuals(ahead)
            gained = float(r @ r - there @ there)
        if gained > 0.0:
            J = J + np.outer(there - r - J @ step, step) / (step @ step)
            x, r, fresh, refused = ahead, there, False, 0
            damping = max(damping * (0.2 if gained > 0.5 * promised else 1.0), 1e-6)
        if gained > converged_gain:
            continue
        if not fresh:
            J, fresh = _without(held, jacobian(x, r)), True
        elif promised <= converged_gain or refused == most_refused:
            break
        else:
            damping, refused = 10.0 * damping, refused + 1
    return Fit(float(r @ r), x, r, J, fresh)


def _without(held: list[int], jacobian: FloatArray) -> FloatArray:
    """Return derivatives by which parameters that are held change nothing."""
    jacobian[:, held] = 0.0
    return jacobian


def _step(
    J: FloatArray, r: FloatArray, x: FloatArray, damping: float, ridge: float
) -> tuple[FloatArray, float]:
    """Return the best damped step within the limits, and the fall of chi-square it promises.

    The least of 2 g^T s + s^T (J^T J + D) s for limits of s (Stark and Parker 1995, Comput. Stat.
    10, 129): a step that is cut off at the limits one by one may promise next to nothing.
    """
    from scipy.optimize import lsq_linear  # half a second that steps without a descent save

    bend, slope = J.T @ J, J.T @ r
    R = np.linalg.cholesky(bend + np.diag(damping * np.diag(bend) + ridge)).T
    best = lsq_linear(
        R, -np.linalg.solve(R.T, slope), (-x, 1.0 - x), method="bvls", max_iter=10 * x.size
    )
    step = np.asarray(best.x)
    return step, -float(2.0 * slope @ step + step @ bend @ step)
