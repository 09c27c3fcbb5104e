"""How much less the points of a signal tell where a model misses it for long.

Misfit lasts over many points, so sums of whitened residuals w vary more than those of noise. With
windows of L points, a tenth of the record, a signal's factor is the larger one of

    f = mean over windows of (sum of w)^2 / L    and    chi-square per point,    1 at least.

The first is the long-run variance with Bartlett's weights (Newey and West 1987,
doi 10.2307/1913610). The variance of the signal's noise counts as f times as large.
"""

import numpy as np
from scipy.stats import chi2

from pyrofit.estimate.apparatus import LASTING
from pyrofit.solver.arrays import FloatArray


def long_run_factor(w: FloatArray) -> float:
    """Return the factor of a signal with whitened residuals w."""
    return max(1.0, long_run_variance(w), float(np.mean(w**2)))


def significant_factor(w: FloatArray, level: float) -> float:
    """Return the factor of a signal, of parts that noise reaches with a probability below a level.

    Noise has chi-square distributions with a degree of freedom a point, or a window.
    """
    found = 1.0
    for factor, freedom in ((float(np.mean(w**2)), w.size), (long_run_variance(w), 1.0 / LASTING)):
        if factor * freedom > float(chi2.isf(level, freedom)):
            found = max(found, factor)
    return found


def long_run_variance(w: FloatArray) -> float:
    """Return the variance of sums over a tenth of a series, per point.

    >>> long_run_variance(np.ones(100)), long_run_variance(np.tile([1.0, -1.0], 50))
    (10.0, 0.0)
    """
    sums, length = _sums(w)
    return float(np.mean(sums**2) / length)


def _sums(w: FloatArray) -> tuple[FloatArray, int]:
    """Return the sums of (n,) or (n, k) over windows of a tenth, and the points of a window."""
    length = max(1, round(LASTING * len(w)))
    total = np.concatenate([np.zeros((1, *w.shape[1:])), np.cumsum(w, axis=0)])
    return total[length:] - total[:-length], length
