"""Eq. 4: the costs that compare the whole curve, one function each.

Each function checks its options and computes once all that depends on the target alone. It returns
a function from the model at the target's times to residuals; the cost is the norm of the residuals.
"""

import math
from functools import partial

from pyrofit.cost.distances import (
    Limits,
    bands_limits,
    range_limits,
    range_limits_propti,
    to_limit,
    to_target,
)
from pyrofit.cost.normalisation import normaliser
from pyrofit.cost.target import FloatArray, Residuals, Target


def _eq4_limit(limits: Limits, factor: float, model: FloatArray) -> FloatArray:
    return factor * to_limit(model, *limits)


def _eq4_target(value: FloatArray, limits: Limits, factor: float, model: FloatArray) -> FloatArray:
    return factor * to_target(model, value, *limits)


def eq4_factor(n_y: int, y_N: float) -> float:
    """Eq. 4: 1 / (y_N sqrt(n_y)), which makes the cost the norm of factor * differences.

    >>> eq4_factor(4, 5.0)
    0.1
    """
    return 1.0 / (y_N * math.sqrt(n_y))


def rmse(target: Target, *, normalisation: str = "none") -> Residuals:
    """Eq. 4 with RMSE of Table 2: sqrt(mean((model - y)^2)) / y_N.

    Parameters
    ----------
    target : Target
        The target y, n points.
    normalisation : str
        y_N of Table 1: none, range, mean or iqr.

    Returns
    -------
    function from array, shape (n,), to array, shape (n,)
        Residuals of a model at the target's times [-, or the unit of y with `none`].

    Raises
    ------
    CostError
        The normalisation is unknown or 0.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Eq. 4.

    Examples
    --------
    >>> import numpy as np
    >>> residuals = rmse(Target([0, 1, 2, 3], [2, 2, 2, 2]), normalisation="mean")
    >>> float(np.linalg.norm(residuals(np.array([2.0, 4.0, 2.0, 2.0]))))  # sqrt(4 / 4) / 2
    0.5
    """
    limits = target.value, target.value
    factor = eq4_factor(target.value.size, normaliser(normalisation, target.value))
    return partial(_eq4_limit, limits, factor)


def range_(target: Target, *, r: float = 0.05, normalisation: str = "none") -> Residuals:
    """Eq. 4 with RANGE of Table 2: only differences outside (1 -+ r) y count.

    Parameters, result, source: as `rmse`, and r [-], the half width of the interval.

    Raises
    ------
    CostError
        r is not above 0; the normalisation is unknown or 0.

    Examples
    --------
    >>> import numpy as np
    >>> residuals = range_(Target([0, 1, 2, 3], [2, 2, 2, 2]), r=0.5)
    >>> float(np.linalg.norm(residuals(np.array([2.0, 5.0, 3.0, 1.0]))))  # sqrt(2^2 / 4)
    1.0
    """
    factor = eq4_factor(target.value.size, normaliser(normalisation, target.value))
    return partial(_eq4_limit, range_limits(target, r), factor)


def bands(
    target: Target,
    *,
    lower: FloatArray | None = None,
    upper: FloatArray | None = None,
    n_sigma: float | None = None,
    smooth_s: float | None = None,
    normalisation: str = "none",
) -> Residuals:
    """Eq. 4 with BANDS of Table 2: only differences outside y_lb to y_ub count.

    Parameters, result, source: as `rmse` and `bands_limits`.

    Raises
    ------
    CostError
        As `bands_limits`, or the normalisation is unknown or 0.

    Examples
    --------
    >>> import numpy as np
    >>> residuals = bands(Target([0, 1, 2, 3], [2, 2, 2, 2], [1, 1, 1, 1]))
    >>> float(np.linalg.norm(residuals(np.array([2.0, 5.0, 3.0, 1.0]))))  # sqrt(2^2 / 4)
    1.0
    """
    # PAPER: BANDS has no y to take y_N from; the target between the limits is taken.
    factor = eq4_factor(target.value.size, normaliser(normalisation, target.value))
    return partial(_eq4_limit, bands_limits(target, lower, upper, n_sigma, smooth_s), factor)


def range_propti(target: Target, *, r: float = 0.05, normalisation: str = "mean") -> Residuals:
    """Eq. 4 with RANGE as PROPTI codes it: outside (1 -+ r) y, the distance to y counts.

    Parameters, result, errors: as `range_`; PROPTI's default normalisation is the mean. A point
    with y < 0 always counts.

    Examples
    --------
    >>> import numpy as np
    >>> residuals = range_propti(Target([0, 1, 2, 3], [2, 2, 2, 2]), r=0.5)
    >>> float(np.linalg.norm(residuals(np.array([2.0, 5.0, 3.0, 1.0]))))  # sqrt(3^2 / 4) / 2
    0.75
    """
    factor = eq4_factor(target.value.size, normaliser(normalisation, target.value))
    return partial(_eq4_target, target.value, range_limits_propti(target, r), factor)


def bands_propti(
    target: Target,
    *,
    lower: FloatArray | None = None,
    upper: FloatArray | None = None,
    n_sigma: float | None = None,
    smooth_s: float | None = None,
    normalisation: str = "mean",
) -> Residuals:
    """Eq. 4 with BANDS as PROPTI codes it: y_N is that of the lower limit.

    Parameters, result, errors: as `bands`; PROPTI's default normalisation is the mean.

    Examples
    --------
    >>> import numpy as np
    >>> residuals = bands_propti(Target([0, 1, 2, 3], [3, 3, 3, 3], [1, 1, 1, 1]))
    >>> float(np.linalg.norm(residuals(np.array([3.0, 6.0, 4.0, 2.0]))))  # sqrt(2^2 / 4) / 2
    0.5
    """
    limits = bands_limits(target, lower, upper, n_sigma, smooth_s)
    factor = eq4_factor(target.value.size, normaliser(normalisation, limits[0]))
    return partial(_eq4_limit, limits, factor)
