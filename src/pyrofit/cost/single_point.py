"""Eqs 1-3: the costs that compare one point or one time, one function each.

Each function checks its options and computes once all that depends on the target alone. It returns
a function from the model at the target's times to one residual; the cost is its magnitude.
"""

from functools import partial

import numpy as np

from pyrofit.cost.target import FloatArray, Residuals, Target, number
from pyrofit.cost.thresholds import first_passage, nearest_time
from pyrofit.errors import CostError


def nrse(target: Target, *, time_s: float) -> Residuals:
    """Eq. 1: the relative difference at one time, |model(t) - y(t)| / |y(t)|.

    Model and target are interpolated linearly.

    Parameters
    ----------
    target : Target
        The target y, n points.
    time_s : float
        The time t [s], within the target's.

    Returns
    -------
    function from array, shape (n,), to array, shape (1,)
        Signed relative difference [-]; the cost is its magnitude.

    Raises
    ------
    CostError
        t lies outside the target's times, or y(t) = 0.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Eq. 1.

    Examples
    --------
    >>> nrse(Target([0, 2], [0, 8]), time_s=1.0)(np.array([0.0, 6.0])).tolist()
    [-0.25]
    """
    t = _time_inside(target, time_s)
    y = float(np.interp(t, target.time_s, target.value))
    if y == 0.0:
        raise CostError(
            f"NRSE: the target is 0 at time_s = {t:g} and Eq. 1 divides by it. Choose another "
            "time, or another cost."
        )
    i = min(int(np.searchsorted(target.time_s, t, side="right")), target.time_s.size - 1) - 1
    share = float((t - target.time_s[i]) / (target.time_s[i + 1] - target.time_s[i]))
    return partial(_relative_difference, i, share, y)


def _relative_difference(i: int, share: float, y: float, model: FloatArray) -> FloatArray:
    at_t = (1.0 - share) * float(model[i]) + share * float(model[i + 1])
    # PAPER: Eq. 1 divides by y; |y| keeps the cost of a negative target positive.
    return np.array([(at_t - y) / abs(y)])


def thr_above(target: Target, *, time_s: float) -> Residuals:
    """Eq. 2: the relative error of the time at which the model first rises above y(t0).

    |t - t0| / t0 with t the first upward crossing of y(t0), interpolated; t = t_min for a model
    that is above throughout; max(|t_min - t0|, |t_max - t0|) / t0 for one that never is above.
    A target that itself rises above y(t0) before t0 does not score 0.

    Parameters
    ----------
    target : Target
        The target y, n points; y(t0) is interpolated.
    time_s : float
        t0 [s], above 0 and within the target's times.

    Returns
    -------
    function from array, shape (n,), to array, shape (1,)
        (t - t0) / t0 [-]; the cost is its magnitude.

    Raises
    ------
    CostError
        t0 is not above 0 or lies outside the target's times.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Eq. 2.

    Examples
    --------
    >>> thr_above(Target([0, 2, 4], [0, 1, 2]), time_s=2.0)(np.array([0.0, 0.0, 2.0])).tolist()
    [0.5]
    """
    # PAPER: Eq. 2 takes the nearest of all times above, which is 0 for any model above at t0.
    # The text speaks of the first time.
    return partial(first_passage, target.time_s, *_level(target, time_s), 1.0)


def thr_below(target: Target, *, time_s: float) -> Residuals:
    """Eq. 3: the relative error of the time at which the model first falls below y(t0).

    As `thr_above`, downwards.

    >>> thr_below(Target([0, 2, 4], [2, 1, 0]), time_s=2.0)(np.array([2.0, 2.0, 0.0])).tolist()
    [0.5]
    """
    return partial(first_passage, target.time_s, *_level(target, time_s), -1.0)


def thr_above_literal(target: Target, *, time_s: float) -> Residuals:
    """Eq. 2 as printed: the smallest |t - t0| / t0 over all times with the model above y(t0).

    Parameters, result, errors: as `thr_above`. A model above at t0 scores 0, whenever it rose.

    >>> target = Target([0, 2, 4], [0, 1, 2])
    >>> thr_above_literal(target, time_s=2.0)(np.array([3.0, 3.0, 3.0])).tolist()
    [0.0]
    """
    return partial(nearest_time, target.time_s, *_level(target, time_s), 1.0)


def thr_below_literal(target: Target, *, time_s: float) -> Residuals:
    """Eq. 3 as printed: the smallest |t - t0| / t0 over all times with the model below y(t0).

    As `thr_above_literal`, downwards.

    >>> target = Target([0, 2, 4], [2, 1, 0])
    >>> thr_below_literal(target, time_s=2.0)(np.array([0.0, 0.0, 0.0])).tolist()
    [0.0]
    """
    return partial(nearest_time, target.time_s, *_level(target, time_s), -1.0)


def _level(target: Target, time_s: float) -> tuple[float, float]:
    """Give y(t0) and t0."""
    t0 = _time_inside(target, number("time_s", time_s, above=0.0))
    return float(np.interp(t0, target.time_s, target.value)), t0


def _time_inside(target: Target, time_s: float) -> float:
    t = number("time_s", time_s)
    first, last = target.time_s[0], target.time_s[-1]
    if not first <= t <= last:
        raise CostError(
            f"time_s = {t:g}; it must lie within the target's times, {first:g} to {last:g} s. "
            "Choose another time or a wider window."
        )
    return t
