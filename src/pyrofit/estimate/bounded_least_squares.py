"""Least squares from a start: Gauss and Newton's steps in a trust region, within limits.

Levenberg (1944, doi 10.1090/qam/10666) with the radius of Moré (1978, doi 10.1007/BFb0067700).
Between derivatives by differences these are updated (Broyden 1965,
doi 10.1090/S0025-5718-1965-0198670-6): a step then costs one simulation instead of one per
parameter. They are made anew where the updated ones mislead, or lead nowhere.
"""

import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.estimate.quadratic import least_within
from pyrofit.numerics import linear
from pyrofit.numerics.columns import Columns
from pyrofit.solver.arrays import FloatArray

MOST_STEPS = 80
"""Steps at most."""
FIRST_RADIUS = 0.5
"""Length of a step at most, in search ranges, before steps have shown how far to trust them."""
SHRINK, GROW = 0.5, 2.5
"""The next radius is so many times the length of a step that fell short, or as promised."""
SHORT, FULL = 0.25, 0.7
"""Share of the promised fall below which a step fell short, and above which it is as promised."""
MISLED = 0.1
"""Share of the promised fall below which updated derivatives are made anew."""
MOST_REFUSED = 1
"""Refused steps in a row with updated derivatives, before these are made anew."""
NEAREST, FARTHEST = 0.75, 1.3
"""A step is as long as the radius if its length over it lies within these."""
MOST_LENGTHS = 15
"""Dampings tried for a step of that length."""
RIDGE = 1e-6
"""Added to the curvature, so that a parameter without influence does not move."""
RAISED = (0.0, 1e-12, 1e-9, 1e-6)
"""Added to it as shares of the largest curvature, the least that leaves it positive definite."""
NEAR = 50.0
"""Largest rise of the sum of squares above a known fit from which a descent may return to it."""
LIKE_PARABOLA = 0.2
"""Largest relative difference of this rise from that of the parabola about the fit."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Where a descent ended: chi-square, x, whitened residuals and their derivatives there.

    chi2 counts known values, too; ``slopes`` are the derivatives, ``fresh`` if they were made at x,
    else made elsewhere and updated. A descent that ``returned`` ended on its way to a known fit.
    """

    chi2: float
    x: FloatArray
    residuals: FloatArray
    slopes: FloatArray | Columns
    fresh: bool = True
    returned: bool = False

    def __post_init__(self) -> None:
        """Keep the derivatives without zeros: a search has hundreds of fits."""
        if not isinstance(self.slopes, Columns):
            object.__setattr__(self, "slopes", Columns.of(self.slopes))

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
    first_radius: float = FIRST_RADIUS,
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
        The descent ends where fresh derivatives promise a smaller fall of the sum, also by a step
        of the first radius.
    begin
        Derivatives to begin with, if some are at hand.
    fixed
        Position of a parameter that keeps its value.
    idle
        Positions of parameters without influence, which keep their values.
    known
        A fit at hand: a descent that leads there ends early.
    most_steps, first_radius, ridge
        As the constants of this module say.
    """
    x = np.clip(x, 0.0, 1.0)
    r = residuals(x)
    chi2, fresh = linear.dot(r, r), begin is None
    held = [] if fixed is None else [fixed]
    moving = [i for i in range(x.size) if i not in idle]
    whole = _without(held, jacobian(x, r) if begin is None else begin.copy())
    J = whole.take(moving, axis=1)
    square = linear.gram(J)
    radius, damping, refused = first_radius, 0.0, 0
    tried, returned = np.inf, False
    for _ in range(most_steps):
        slope = linear.product(J.T, r)
        taken, promised, damping = _step(square, slope, x[moving], radius, damping, ridge)
        length = linear.norm(taken)
        if promised > converged_gain:
            step = np.zeros(x.size)
            step[moving] = taken
            ahead = np.clip(x + step, 0.0, 1.0)  # a rate rounded below zero is no rate
            there = residuals(ahead)
            fallen = linear.dot(there, there)
            gained = chi2 - fallen
            radius = _radius(radius, length, gained / promised)
            updated, refused = not fresh, refused + 1
            if gained > 0.0:
                missed = (there - r - linear.product(J, taken)) / linear.dot(taken, taken)
                square = _updated(square, linear.product(J.T, missed), missed, taken)
                J += np.outer(missed, taken)
                x, r, chi2, fresh, refused = ahead, there, fallen, False, 0
                returned = known is not None and known.leads_here(x, chi2)
            if returned:
                break
            if gained > converged_gain and not (updated and gained < MISLED * promised):
                continue
            if updated and 0 < refused <= MOST_REFUSED:
                continue
        if not fresh:
            whole, fresh, refused = _without(held, jacobian(x, r)), True, 0
            J = whole.take(moving, axis=1)
            square = linear.gram(J)
        elif promised <= converged_gain:
            if length < NEAREST * radius or chi2 > tried - converged_gain:
                break
            tried, radius = chi2, first_radius  # a shorter step promises less
    whole[:, moving] = J
    return Fit(chi2, x, r, whole, fresh, returned)


def _radius(radius: float, length: float, reached: float) -> float:
    """Return the next radius from the share of the promised fall that a step reached."""
    if reached < SHORT:
        return SHRINK * min(length, radius)
    return max(radius, GROW * length) if reached > FULL else radius


def _without(held: list[int], jacobian: FloatArray) -> FloatArray:
    """Return derivatives by which parameters that are held change nothing."""
    jacobian[:, held] = 0.0
    return jacobian


def _updated(
    square: FloatArray, along: FloatArray, missed: FloatArray, taken: FloatArray
) -> FloatArray:
    """Return (J + m s^T)^T (J + m s^T) from J^T J, J^T m, m and s."""
    both = np.outer(along, taken)
    return np.asarray(square + both + both.T + linear.dot(missed, missed) * np.outer(taken, taken))


def _step(
    square: FloatArray,
    slope: FloatArray,
    x: FloatArray,
    radius: float,
    damping: float,
    ridge: float,
) -> tuple[FloatArray, float, float]:
    """Return the best step of a length within the limits, the fall it promises, and its damping.

    The least of 2 g^T s + s^T (J^T J + D) s for limits of s (Stark and Parker 1995, Comput. Stat.
    10, 129): a step that is cut off at the limits one by one may promise next to nothing. D is the
    least damping, equal for all parameters, that makes the step as short as the radius.
    """

    def damped(by: float) -> FloatArray:
        raised = square + np.diag(np.full(slope.size, by + ridge))
        for share in RAISED:  # parameters that do the same have a curvature of rounding
            more = share * np.diag(square).max(initial=0.0)
            with contextlib.suppress(np.linalg.LinAlgError):
                return least_within(raised + more * np.eye(x.size), slope, -x, 1.0 - x)
        raise np.linalg.LinAlgError("the derivatives are not finite")

    # 1/length is nearly a line over the damping; of large dampings its slope is 1/|g|.
    by, before = damping, (-1.0, 0.0)
    for _ in range(MOST_LENGTHS):
        step = damped(by)
        length = linear.norm(step)
        is_short = length <= FARTHEST * radius
        if is_short and (length >= NEAREST * radius or by == 0.0 or length == 0.0):
            break
        rise = (1.0 / length - before[1]) / (by - before[0])
        if before[0] < 0.0 or rise <= 0.0:
            rise = 1.0 / linear.norm(slope)
        before = by, 1.0 / length
        by = max(by + (1.0 / radius - before[1]) / rise, 0.0)
    fall = -2.0 * linear.dot(slope, step) - linear.dot(step, linear.product(square, step))
    return step, fall, by
