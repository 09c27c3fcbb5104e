"""Least squares from a start: Levenberg and Marquardt with Broyden's updates, within limits.

Marquardt (1963, doi 10.1137/0111030); Broyden (1965, doi 10.1090/S0025-5718-1965-0198670-6). A
step costs one simulation instead of one per parameter; the derivatives are made anew where the
updated ones lead nowhere.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.numerics import fitting, linear
from pyrofit.numerics.columns import Columns
from pyrofit.solver.arrays import FloatArray

MOST_STEPS = 80
"""Steps at most."""
MOST_REFUSED = 8
"""Refused steps in a row, each with ten times the damping, before a descent ends."""
MOST_REFUSED_UPDATED = 2
"""Refused steps in a row with updated derivatives, before these are made anew."""
RIDGE = 1e-6
"""Added to the curvature, so that a parameter without influence does not move."""
NEAR = 50.0
"""Largest rise of the sum of squares above a known fit from which a descent may return to it."""
LIKE_PARABOLA = 0.2
"""Largest relative difference of this rise from that of the parabola about the fit."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Where a descent ended: chi-square, x, whitened residuals and their derivatives there.

    chi2 counts known values, too; ``slopes`` are the derivatives, made at x only where they are
    ``fresh``, and there of second order where they are ``exact``. A descent that ``returned`` ended
    on its way to a known fit.
    """

    chi2: float
    x: FloatArray
    residuals: FloatArray
    slopes: FloatArray | Columns
    fresh: bool = True
    returned: bool = False
    exact: bool = True

    def __post_init__(self) -> None:
        """Keep the derivatives without zeros: a search has hundreds of fits."""
        if not isinstance(self.slopes, Columns):
            object.__setattr__(self, "slopes", Columns.of(self.slopes))

    @property
    def order(self) -> int:
        """Order of the derivatives, 0 where they were made elsewhere and updated."""
        return 2 if self.exact and self.fresh else int(self.fresh)

    @property
    def jacobian(self) -> FloatArray:
        """The derivatives, a new array of shape (points + known, parameters)."""
        assert isinstance(self.slopes, Columns)
        return self.slopes.dense

    def leads_here(self, x: FloatArray, chi2: float) -> bool:
        """Return whether a descent at x leads to this fit.

        It does if chi-square is near that of the fit, and near the parabola about it.
        """
        found = chi2 - self.chi2
        if not self.fresh or not 0.0 < found < NEAR:
            return False
        parabola = self.residuals + linear.product(self.jacobian, x - self.x)
        rise = linear.dot(parabola, parabola) - self.chi2
        return abs(found - rise) < LIKE_PARABOLA * found


def minimise(
    residuals: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray, FloatArray], FloatArray],
    x: FloatArray,
    converged_gain: float,
    *,
    begin: FloatArray | None = None,
    fixed: int | None = None,
    idle: Sequence[int] = (),
    known: Fit | None = None,
    most_steps: int = MOST_STEPS,
    most_refused: int = MOST_REFUSED,
    most_refused_updated: int = MOST_REFUSED_UPDATED,
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
    idle
        Positions of parameters without influence, which keep their values.
    known
        A fit at hand: a descent that leads there ends early.
    most_steps, most_refused, most_refused_updated, ridge
        As the constants of this module say.
    """
    x = np.clip(x, 0.0, 1.0)
    r = residuals(x)
    fresh = begin is None
    held = [] if fixed is None else [fixed]
    moving = [i for i in range(x.size) if i not in idle]
    whole = _without(held, jacobian(x, r)) if begin is None else begin
    J, bent = _columns(whole, moving), None
    damping, refused, returned = 1e-3, 0, False
    for _ in range(most_steps):
        bent = _bend(J, r) if bent is None else bent  # a refused step changes neither
        step, damped = np.zeros(x.size), damping * 10.0**refused
        step[moving], promised = _step(*bent, x[moving], damped, ridge)
        step[held] = 0.0
        gained = -1.0
        if promised > converged_gain:
            ahead = np.clip(x + step, 0.0, 1.0)  # a rate rounded below zero is no rate
            there = residuals(ahead)
            gained = linear.dot(r, r) - linear.dot(there, there)
        if gained > 0.0:
            taken = step[moving]
            missed = there - r - linear.product(J, taken)
            J, bent = J + np.outer(missed, taken) / linear.dot(taken, taken), None
            damping = _damping(damped, gained / promised)
            x, r, fresh, refused = ahead, there, False, 0
            returned = known is not None and known.leads_here(x, linear.dot(r, r))
        if returned:
            break
        if gained > converged_gain:
            continue
        is_refused = gained <= 0.0 and promised > converged_gain
        if is_refused and refused < (most_refused if fresh else most_refused_updated):
            refused += 1
        elif not fresh:
            whole, fresh = _without(held, jacobian(x, r)), True
            J, bent, refused = _columns(whole, moving), None, 0
        else:
            break
    whole = whole.copy()
    whole[:, moving] = J
    return Fit(linear.dot(r, r), x, r, whole, fresh, returned)


def _damping(damping: float, reached: float) -> float:
    """Return the next damping from the share of the promised fall that a step reached."""
    factor = 0.2 if reached > 0.5 else 1.0 if reached > 0.1 else 5.0
    return float(np.clip(factor * damping, 1e-6, 1e3))


def _columns(jacobian: FloatArray, moving: list[int]) -> FloatArray:
    """Return the derivatives by the moving parameters."""
    return jacobian if len(moving) == jacobian.shape[1] else jacobian.take(moving, axis=1)


def _without(held: list[int], jacobian: FloatArray) -> FloatArray:
    """Return derivatives by which parameters that are held change nothing."""
    jacobian[:, held] = 0.0
    return jacobian


def _bend(J: FloatArray, r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return J^T J and J^T r."""
    return linear.gram(J), linear.product(J.T, r)


def _step(
    bend: FloatArray, slope: FloatArray, x: FloatArray, damping: float, ridge: float
) -> tuple[FloatArray, float]:
    """Return the best damped step within the limits, and the fall of chi-square it promises.

    The least of 2 g^T s + s^T (J^T J + D) s for limits of s (Stark and Parker 1995, Comput. Stat.
    10, 129): a step that is cut off at the limits one by one may promise next to nothing.
    """
    damped = bend + np.diag(damping * np.diag(bend) + ridge)
    step = fitting.within_limits(damped, slope, -x, 1.0 - x)
    return step, -2.0 * linear.dot(slope, step) - linear.dot(step, linear.product(bend, step))
