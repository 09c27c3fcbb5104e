"""Single points far off their neighbours, as where a balance is touched.

A rate that is the difference of such a mass has two opposite spikes side by side, which are not
found.
"""

import numpy as np

from pyrofit.solver.arrays import FloatArray

FAR = 8.0
"""Standard deviations of the distance from the neighbours; noise is hardly ever so far off."""
ABOVE_NEIGHBOURS = 3.0
"""Least distance over the range of the neighbours, which is large where the curve is steep."""
LEAST_SHARE = 0.002
"""Least standard deviation as a share of the range: a record may have equal values for long."""
NORMAL = 1.4826
"""Standard deviation over the median of the absolute deviations, of normal numbers."""


def spikes(value: FloatArray) -> FloatArray:
    """Return how far spikes are from the median of their four neighbours, zero for other points.

    d_i = y_i - median(y_(i-2), y_(i-1), y_(i+1), y_(i+2)) is a spike if |d_i| exceeds 8 robust
    standard deviations of all d, and 3 times the range of the four neighbours. That standard
    deviation is at least 0.2 % of the range of the series.

    Parameters
    ----------
    value
        The series, shape (n,); the first and last two points are never spikes.

    >>> float(spikes(np.array([0.0, 1.0, 2.0, 30.0, 4.0, 5.0, 6.0]))[3])
    27.0
    """
    found = np.zeros(value.size)
    if value.size < 5:
        return found
    around = np.stack([value[:-4], value[1:-3], value[3:-1], value[4:]])
    d = value[2:-2] - np.median(around, axis=0)
    sd = max(
        NORMAL * float(np.median(np.abs(d))), LEAST_SHARE * float(np.ptp(np.median(around, axis=0)))
    )
    far = (np.abs(d) > FAR * sd) & (np.abs(d) > ABOVE_NEIGHBOURS * np.ptp(around, axis=0))
    found[2:-2][far] = d[far]
    return found
