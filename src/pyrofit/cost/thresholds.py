"""When a model passes a level: the readings of Eqs 2 and 3.

Both functions give (t - t0) / t0, signed, so that its magnitude is the cost.
"""

import math

import numpy as np

from pyrofit.cost.target import FloatArray


def first_passage(
    time_s: FloatArray, level: float, t0: float, sign: float, model: FloatArray
) -> FloatArray:
    """Eqs 2 and 3, the first time that the model passes the level.

    Parameters
    ----------
    time_s, model : array, shape (n,)
        Times [s] and the model at them.
    level : float
        The level y(t0), in the unit of the model.
    t0 : float
        The time [s] at which the level should be passed.
    sign : float
        1 where the model must rise above the level, -1 where it must fall below.

    Returns
    -------
    array, shape (1,)
        (t - t0) / t0 [-], infinite if the model is not finite.

    Examples
    --------
    >>> first_passage(np.array([0.0, 2.0, 4.0]), 1.0, 2.0, 1.0, np.array([0.0, 0.0, 2.0])).tolist()
    [0.5]
    """
    if not np.isfinite(model).all():
        return np.array([math.inf])
    excess = sign * (model - level)
    met = excess > 0.0
    begins = met[1:] > met[:-1]
    first = int(begins.argmax())
    if begins[first]:
        offset = _crossing(time_s, excess, first) - t0
    elif met[0]:
        # PAPER: a condition met from the first point to its end was never passed; it holds since
        # t_min. A model that meets it at first and passes it later is judged by the passage, else
        # every mass loss rate, which starts at 0, would "fall below" at t_min.
        offset = float(time_s[0]) - t0
    else:
        offset = farthest(time_s, t0)
    return np.array([offset / t0])


def nearest_time(
    time_s: FloatArray, level: float, t0: float, sign: float, model: FloatArray
) -> FloatArray:
    """Eqs 2 and 3 read literally: the time nearest to t0 at which the model is beyond the level.

    Parameters, result: as `first_passage`. Between the points the model is a straight line.

    >>> time, model = np.array([0.0, 2.0, 4.0]), np.array([3.0, 3.0, 0.0])
    >>> nearest_time(time, 1.0, 2.0, 1.0, model).tolist()
    [0.0]
    """
    if not np.isfinite(model).all():
        return np.array([math.inf])
    excess = sign * (model - level)
    if np.interp(t0, time_s, excess) > 0.0:
        return np.array([0.0])
    met = excess > 0.0
    changes = np.flatnonzero(met[1:] != met[:-1])  # t0 is outside, so the nearest is a change
    offsets = [_crossing(time_s, excess, i) - t0 for i in changes.tolist()]
    return np.array([min(offsets, key=abs, default=farthest(time_s, t0)) / t0])


def farthest(time_s: FloatArray, t0: float) -> float:
    """Eqs 2 and 3: max(|t_min - t0|, |t_max - t0|), where the level is never passed.

    >>> farthest(np.array([0.0, 3.0, 4.0]), 1.0)
    3.0
    """
    # PAPER: t_min and t_max are not defined; they are the ends of the compared time axis.
    return float(max(abs(time_s[0] - t0), abs(time_s[-1] - t0)))


def _crossing(time_s: FloatArray, excess: FloatArray, i: int) -> float:
    """Interpolate the zero of the excess between points i and i + 1."""
    start, end = float(time_s[i]), float(time_s[i + 1])
    before, after = float(excess[i]), float(excess[i + 1])
    return start + (end - start) * before / (before - after)
