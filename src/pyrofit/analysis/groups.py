"""Do groups differ in where they lie, and in how far they scatter? Tests that assume no shape.

Repetitions of a search are independent and their ends are far from normal: the tests use ranks, or
distances from the median. Each returns a probability and, where there is one, the size of the
effect, as many repetitions make any difference significant.
"""

from collections.abc import Sequence

import numpy as np

from pyrofit.solver.arrays import FloatArray

FEWEST = 5
"""Fewest values of a group to be tested: with 4 and 4, no pair can be found to differ at 0.01."""


def enough(groups: Sequence[FloatArray]) -> bool:
    """Tell whether there are at least two groups, each of enough values."""
    return len(groups) > 1 and min(group.size for group in groups) >= FEWEST


def location(groups: Sequence[FloatArray]) -> tuple[float, float]:
    """Return p of Kruskal and Wallis's test (1952), and the share of the ranks' variance.

    The share is epsilon^2 = H / (n - 1), doi 10.1080/01621459.1952.10483441: 0 where all groups lie
    at the same place, 1 where they are apart.

    >>> p, share = location([np.arange(5.0), np.arange(5.0) + 10.0])
    >>> round(p, 3), round(share, 3)
    (0.009, 0.758)
    """
    from scipy.stats import kruskal

    together = np.concatenate(groups)
    if np.ptp(together) == 0.0:
        return 1.0, 0.0
    found = kruskal(*groups)
    return float(found.pvalue), float(found.statistic) / (together.size - 1)


def pair(first: FloatArray, second: FloatArray) -> tuple[float, float]:
    """Return p of Mann and Whitney's test (1947), and Cliff's delta = P(x > y) - P(x < y).

    >>> p, delta = pair(np.arange(5.0), np.arange(5.0) + 10.0)
    >>> round(p, 4), delta
    (0.0079, -1.0)
    """
    from scipy.stats import mannwhitneyu

    if np.ptp(np.concatenate([first, second])) == 0.0:
        return 1.0, 0.0
    found = mannwhitneyu(first, second)
    delta = 2.0 * float(found.statistic) / (first.size * second.size) - 1.0
    return float(found.pvalue), delta


def spread_test(groups: Sequence[FloatArray]) -> float:
    """Return p of Brown and Forsythe's test (1974, doi 10.1080/01621459.1974.10482955).

    It compares the distances from the medians.

    >>> round(spread_test([np.arange(9.0), 100.0 * np.arange(9.0)]), 4)
    0.0002
    """
    from scipy.stats import f_oneway

    away = [np.abs(group - np.median(group)) for group in groups]
    if all(np.ptp(part) == 0.0 for part in away):
        return 1.0 if np.ptp(np.concatenate(away)) == 0.0 else 0.0
    return float(f_oneway(*away).pvalue)


def holm(p: Sequence[float]) -> list[float]:
    """Return probabilities corrected for their number, Holm (1979).

    The k-th smallest of m is multiplied by m - k + 1, and is no less than those before it.

    >>> [round(x, 3) for x in holm([0.01, 0.04, 0.03])]
    [0.03, 0.06, 0.06]
    """
    values = np.asarray(p, dtype=float)
    order = np.argsort(values, kind="stable")
    factors = np.arange(values.size, 0, -1)
    corrected = np.empty_like(values)
    corrected[order] = np.minimum(np.maximum.accumulate(values[order] * factors), 1.0)
    return [float(x) for x in corrected]
