"""Table 1: the divisors of an Eq. 4 cost."""

from collections.abc import Callable

import numpy as np

from pyrofit.cost.target import FloatArray
from pyrofit.errors import CostError, suggest


def _one(series: FloatArray) -> float:
    return 1.0


def _range(series: FloatArray) -> float:
    return float(series.max() - series.min())


def _mean(series: FloatArray) -> float:
    # PAPER: Table 1 divides by the mean; a negative mean would make the cost negative.
    return abs(float(series.mean()))


def _iqr(series: FloatArray) -> float:
    # PAPER: CDF_y^-1 of a sample is read as the quantile interpolated linearly between points.
    low, high = np.quantile(series, [0.25, 0.75])
    return float(high - low)


NORMALISATIONS: dict[str, Callable[[FloatArray], float]] = {
    "none": _one,
    "range": _range,
    "mean": _mean,
    "iqr": _iqr,
}
"""Table 1: y_N by name; with them RMSE is RMSE, NRMSE, CV(RMSE) and IQRMSE."""


def normaliser(name: str, series: FloatArray) -> float:
    """Table 1: y_N, by which an Eq. 4 cost is divided.

    none: 1; range: y_max - y_min; mean: abs(mean(y)); iqr: CDF_y^-1(0.75) - CDF_y^-1(0.25).

    Parameters
    ----------
    name : str
        One of `NORMALISATIONS`.
    series : array, shape (n,)
        The target y, in its unit.

    Returns
    -------
    float
        y_N, in the unit of y (none: 1).

    Raises
    ------
    CostError
        The name is unknown, or y_N is 0.

    References
    ----------
    Lauer et al., Role of the cost function for material parameter estimation, Table 1.

    Examples
    --------
    >>> [normaliser(name, np.array([1.0, 3.0, 8.0])) for name in NORMALISATIONS]
    [1.0, 7.0, 4.0, 3.5]
    """
    if name not in NORMALISATIONS:
        raise CostError(f"unknown normalisation '{name}'. {suggest(str(name), NORMALISATIONS)}")
    y_N = NORMALISATIONS[name](series)
    if y_N == 0.0:
        raise CostError(
            f"normalisation '{name}' is 0 for this target, as of a record that does not change; a "
            "cost cannot be divided by it. Check the column of the file. "
            f"Choose another one of {', '.join(NORMALISATIONS)}."
        )
    return y_N
