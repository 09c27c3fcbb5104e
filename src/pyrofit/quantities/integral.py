"""The integral of a rate that is recorded in bins."""

import numpy as np

from pyrofit.numerics import linear
from pyrofit.quantities.base import FloatArray


def integral(time: FloatArray, rate: FloatArray) -> float:
    """Return the integral of a rate over time, such as of a mass loss rate [kg/m2].

    Each value is taken as the mean over a bin around its time,

        M = sum_i mlr_i (e_(i+1) - e_i),
        e_0 = 0,  e_i = (t_(i-1) + t_i) / 2,  e_n = t_(n-1)  for times t_0 ... t_(n-1).

    The first bin reaches back to t = 0, where the exposure starts, and nothing is added after the
    last time: M equals the trapezoidal rule plus `mlr_0 t_0`. Negative values count as they are.

    Parameters
    ----------
    time : times [s], increasing, shape (n,).
    rate : rate, such as a mass loss rate [kg/(m2 s)], shape (n,).

    Examples
    --------
    >>> integral(np.array([5.0, 15.0, 25.0]), np.array([0.1, 0.2, 0.1]))  # 1 + 2 + 0.5
    3.5
    """
    edges = np.concatenate(([0.0], 0.5 * (time[:-1] + time[1:]), time[-1:]))
    return linear.dot(rate, np.diff(edges))
