"""Table 2: the difference between model and target at each time, and PROPTI's coded forms.

Every distance of Table 2 follows from two limits. They are computed once for a target; the
distance of a model from them is `to_limit` (Table 2) or `to_target` (PROPTI's RANGE).
"""

import numpy as np
from numpy.typing import ArrayLike

from pyrofit.cost.target import FloatArray, Target, checked_curve, number
from pyrofit.errors import CostError

Limits = tuple[FloatArray, FloatArray]


def root_mean_square(values: ArrayLike) -> float:
    """Return the root of the mean of squares.

    >>> root_mean_square([3.0, -3.0, 3.0, 3.0])
    3.0
    """
    return float(np.sqrt(np.mean(np.square(values))))


def to_limit(model: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Table 2: signed distance to the nearer limit, 0 between the limits.

    >>> to_limit(np.array([0.0, 2.0, 5.0]), np.ones(3), np.full(3, 3.0)).tolist()
    [-1.0, 0.0, 2.0]
    """
    return model - np.minimum(np.maximum(model, lower), upper)


def to_target(
    model: FloatArray, value: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """Give the signed distance to the target, 0 between the limits (PROPTI's RANGE).

    >>> ones = np.ones(3)
    >>> to_target(np.array([0.0, 2.0, 5.0]), 2 * ones, ones, 3 * ones).tolist()
    [-2.0, 0.0, 3.0]
    """
    return np.where((model >= lower) & (model <= upper), 0.0, model - value)


def range_limits(target: Target, r: float = 0.05) -> Limits:
    """Table 2: the limits (1 - r) y and (1 + r) y of RANGE, in ascending order.

    >>> [limit.tolist() for limit in range_limits(Target([0, 1], [2, -2]), r=0.5)]
    [[1.0, -3.0], [3.0, -1.0]]
    """
    # PAPER: for y < 0 the limits as printed are in the wrong order and nothing lies between them.
    one, other = range_limits_propti(target, r)
    return np.minimum(one, other), np.maximum(one, other)


def range_limits_propti(target: Target, r: float = 0.05) -> Limits:
    """Give (1 - r) y and (1 + r) y in this order, as PROPTI does: for y < 0 nothing lies between.

    >>> [limit.tolist() for limit in range_limits_propti(Target([0, 1], [2, -2]), r=0.5)]
    [[1.0, -1.0], [3.0, -3.0]]
    """
    r = number("r", r, above=0.0)
    return (1.0 - r) * target.value, (1.0 + r) * target.value


def bands_limits(
    target: Target,
    lower: FloatArray | None = None,
    upper: FloatArray | None = None,
    n_sigma: float | None = None,
    smooth_s: float | None = None,
) -> Limits:
    """Table 2: the limits y_lb and y_ub of BANDS.

    They are given as two series, or are y -+ n_sigma times the uncertainty of the target.

    Parameters
    ----------
    target : Target
        The target, n points.
    lower, upper : array, shape (n,), optional
        The limits at the target's times, in its unit; both or neither.
    n_sigma : float, optional
        Multiple of the uncertainty, 1 if neither this nor the limits are given.
    smooth_s : float, optional
        Width [s] of a moving average over the limits: at t, the mean of the points within
        t -+ smooth_s / 2, fewer at the ends.

    Returns
    -------
    tuple of two arrays, shape (n,)
        Lower and upper limit.

    Raises
    ------
    CostError
        One limit stands alone, or limits together with `n_sigma`. Limits and uncertainty are
        absent. A length is wrong, a lower limit is above the upper, or an option is not above 0.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Table 2.

    Examples
    --------
    >>> target = Target([0, 1, 2], [1, 4, 1], [1, 1, 1])
    >>> [limit.tolist() for limit in bands_limits(target, smooth_s=2.0)]
    [[1.5, 1.0, 1.5], [3.5, 3.0, 3.5]]
    """
    limits = _bands_as_given(target, lower, upper, n_sigma)
    if smooth_s is None:
        return limits
    width = number("smooth_s", smooth_s, above=0.0)
    return _smooth(target.time_s, limits[0], width), _smooth(target.time_s, limits[1], width)


def _bands_as_given(target: Target, lower: object, upper: object, n_sigma: float | None) -> Limits:
    if lower is None and upper is None:
        if target.uncertainty is None:
            raise CostError(
                "BANDS: the target has no uncertainty; the limits follow from it. Give the target "
                "an uncertainty, or give `lower` and `upper`."
            )
        half = number("n_sigma", 1.0 if n_sigma is None else n_sigma, above=0.0)
        return target.value - half * target.uncertainty, target.value + half * target.uncertainty
    if lower is None or upper is None or n_sigma is not None:
        raise CostError("BANDS: give both `lower` and `upper`, or `n_sigma` alone.")
    limits = checked_curve("lower", lower), checked_curve("upper", upper)
    for name, limit in zip(("lower", "upper"), limits, strict=True):
        if limit.size != target.time_s.size:
            raise CostError(
                f"BANDS: {name} has {limit.size} points and the target has {target.time_s.size}; "
                "give one for each time of the target."
            )
    if (crossed := np.flatnonzero(limits[0] > limits[1])).size:
        raise CostError(
            f"BANDS: lower[{crossed[0]}] lies above upper[{crossed[0]}]; no model lies between. "
            "Exchange the two limits."
        )
    return limits


def _smooth(time_s: FloatArray, series: FloatArray, width_s: float) -> FloatArray:
    reach = 0.5 * width_s * (1.0 + 1e-9)  # a point on the edge counts, whatever its rounding
    first = np.searchsorted(time_s, time_s - reach, side="left")
    last = np.searchsorted(time_s, time_s + reach, side="right")
    return np.array([series[i:j].mean() for i, j in zip(first, last, strict=True)])


def rmse_differences(target: Target, model: FloatArray) -> FloatArray:
    """Table 2, RMSE: the model minus the target at each time.

    >>> rmse_differences(Target([0, 1], [1, 2]), np.array([4.0, 0.0])).tolist()
    [3.0, -2.0]
    """
    return model - target.value


def range_differences(target: Target, model: FloatArray, r: float = 0.05) -> FloatArray:
    """Table 2, RANGE: the distance to the edge of the interval (1 -+ r) y, 0 inside.

    Parameters
    ----------
    target : Target
        The target y, n points.
    model : array, shape (n,)
        The model at the target's times, in its unit.
    r : float
        Half width of the interval as a share of y [-], above 0.

    Returns
    -------
    array, shape (n,)
        Differences, in the unit of the target.

    Raises
    ------
    CostError
        r is not above 0.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Table 2.

    Examples
    --------
    >>> target = Target([0, 1, 2], [2, 2, -2])
    >>> range_differences(target, np.array([2.5, 4.0, 0.0]), r=0.5).tolist()
    [0.0, 1.0, 1.0]
    """
    return to_limit(model, *range_limits(target, r))


def bands_differences(target: Target, model: FloatArray) -> FloatArray:
    """Table 2, BANDS: the distance to the nearer of two limits, 0 between them.

    PROPTI codes the same distance; its `BANDS_PROPTI` differs in the normalisation alone.
    The limits are those of `bands_limits`; the model, shape (n,), is at the target's times.

    >>> target = Target([0, 1, 2], [2, 2, 2], uncertainty=[1, 1, 0.5])
    >>> bands_differences(target, np.array([2.5, 0.0, 4.0])).tolist()
    [0.0, -1.0, 1.5]
    """
    return to_limit(model, *bands_limits(target))
