"""How costs rank stored parameter sets: sample, rank correlation, regret, valleys. Arrays only."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

VALLEY = 0.01
"""Share of the sets, the best ones, that are called the valley of a cost."""
GOOD = 0.1
"""Share of the sets, the best ones of a cost, among which the order of others is compared."""
ALIKE = 0.95
"""Least rank correlation of two costs that are said to rank alike."""
SAME = 1.0 - 1e-9
"""Rank correlation from which on two costs rank the sets in the same order."""


@dataclass(frozen=True, eq=False)
class Valley:
    """The best sets of a cost.

    Parameters
    ----------
    best
        Position of the best set.
    value
        Its cost.
    sets
        Number of sets in the valley, ties at its edge included.
    low, high
        Range of each parameter over them, shape (parameters,), in the unit given.
    """

    best: int
    value: float
    sets: int
    low: FloatArray
    high: FloatArray


def strata(costs: FloatArray, count: int) -> NDArray[np.int64]:
    """Return positions of sets that stand for all quantiles of their own cost.

    The sets, sorted by cost, are cut into ``count`` parts of the same size. The lowest of each part
    is taken, and thus the lowest of all. Ties keep their order.

    >>> strata(np.array([5.0, 1.0, 3.0, 2.0, 4.0, 6.0]), 3).tolist()
    [1, 2, 0]
    """
    order = np.argsort(costs, kind="stable")
    if count >= order.size:
        return order
    return order[np.arange(count) * order.size // count]


def shares_of_histories(sizes: Sequence[int], total: int) -> list[int]:
    """Return how many sets are taken of each history, the same of each as far as it has them.

    Histories that are too short leave their share to the others.

    >>> shares_of_histories([10, 3, 10], 15)
    [6, 3, 6]
    """
    taken = [0] * len(sizes)
    left = min(total, sum(sizes))
    while left:
        open_ones = [i for i, size in enumerate(sizes) if taken[i] < size]
        each, more = divmod(left, len(open_ones))
        for k, i in enumerate(open_ones):
            taken[i] += min(each + (k < more), sizes[i] - taken[i])
        left = min(total, sum(sizes)) - sum(taken)
    return taken


def telling(scores: pd.DataFrame) -> list[str]:
    """Return the costs that do not give all sets the same value."""
    return [str(name) for name in scores if scores[name].nunique() > 1]


def spearman(scores: pd.DataFrame) -> pd.DataFrame:
    """Return Spearman's rank correlation of the columns; ties have their mean rank.

    Every column must have two values at least.

    >>> spearman(pd.DataFrame({"a": [1, 2, 3], "b": [10, 30, 20]})).loc["a", "b"].item()
    0.5
    """
    ranks = scores.rank().to_numpy()
    matrix = linear.correlation(ranks.T)
    np.fill_diagonal(matrix, 1.0)
    return pd.DataFrame(matrix, index=scores.columns, columns=scores.columns)


def spearman_among_best(scores: pd.DataFrame, share: float = GOOD) -> pd.DataFrame:
    """Return the rank correlation of two costs over the best sets of the first (row).

    Over all sets, costs agree on the bad ones, which are many; here the bad ones are left out. The
    best sets are those of `valley` with its ``share``. A cost that does not tell them apart has no
    relation, 0. The table is not symmetric.

    >>> scores = pd.DataFrame({"a": [1, 2, 3, 9, 9, 9], "b": [3, 2, 1, 9, 9, 9]})
    >>> spearman_among_best(scores, 0.5).loc["a", "b"].item()
    -1.0
    """
    found = pd.DataFrame(np.eye(scores.shape[1]), index=scores.columns, columns=scores.columns)
    count = max(1, int(np.ceil(share * len(scores))))
    for row in scores:
        best = scores[scores[row] <= scores[row].nsmallest(count).iloc[-1]]
        own = best[row].rank()
        for column in scores:
            told = best[column].nunique() > 1 < best[row].nunique()
            if column != row:
                found.loc[row, column] = _correlation(own, best[column].rank()) if told else 0.0
    return found


def _correlation(x: "pd.Series[float]", y: "pd.Series[float]") -> float:
    return float(linear.correlation(np.array([x, y]))[0, 1])


def grouped(correlation: pd.DataFrame, least: float) -> list[list[str]]:
    """Return groups of costs of which each two correlate by ``least`` or more.

    The two groups that agree best are joined first, as long as all their pairs agree (complete
    linkage). Groups and their members keep the order of the matrix.
    """
    matrix = correlation.to_numpy()
    groups = [[i] for i in range(len(matrix))]
    while len(groups) > 1:
        pairs = [
            (-float(matrix[np.ix_(a, b)].min()), i, k)
            for i, a in enumerate(groups)
            for k, b in enumerate(groups[:i])
        ]
        worst, i, k = min(pairs)
        if -worst < least:
            break
        groups[k] = sorted(groups[k] + groups.pop(i))
    return [[str(correlation.index[i]) for i in group] for group in sorted(groups)]


def valley(scores: FloatArray, sets: FloatArray, share: float = VALLEY) -> Valley:
    """Return where the best sets of a cost lie.

    Parameters
    ----------
    scores
        Cost of each set, shape (sets,).
    sets
        The sets, shape (sets, parameters).
    share
        Share of the sets that count as the best, one at least; sets that tie with the last of
        these count as well.
    """
    count = max(1, int(np.ceil(share * scores.size)))
    edge = np.partition(scores, count - 1)[count - 1]
    inside = sets[scores <= edge]
    best = int(scores.argmin())
    return Valley(best, float(scores[best]), len(inside), inside.min(axis=0), inside.max(axis=0))


def excess(scores: pd.DataFrame) -> pd.DataFrame:
    """Return how much higher the best set of each cost (row) is under every other (column).

    (value - lowest value) / lowest value [-]; not a number where the lowest value is 0.

    >>> excess(pd.DataFrame({"a": [1.0, 2.0], "b": [6.0, 4.0]})).loc["a", "b"].item()
    0.5
    """
    best = scores.to_numpy()[scores.to_numpy().argmin(axis=0)]
    lowest = scores.min().to_numpy()
    over = np.divide(best - lowest, lowest, out=np.full(best.shape, np.nan), where=lowest > 0.0)
    return pd.DataFrame(over, index=scores.columns, columns=scores.columns)


def better(scores: pd.DataFrame) -> pd.DataFrame:
    """Return the share of sets better under a cost (column) than the best set of another (row).

    >>> better(pd.DataFrame({"a": [1.0, 2.0], "b": [6.0, 4.0]})).loc["a", "b"].item()
    0.5
    """
    values = scores.to_numpy()
    best = values[values.argmin(axis=0)]
    found = np.array([(values < row).mean(axis=0) for row in best])
    return pd.DataFrame(found, index=scores.columns, columns=scores.columns)


def least_alike(correlation: pd.DataFrame) -> tuple[str, str, float]:
    """Return the two costs that agree least, and their rank correlation."""
    matrix = correlation.to_numpy()
    rows, columns = np.triu_indices(len(matrix), 1)
    at = int(matrix[rows, columns].argmin())
    i, k = int(rows[at]), int(columns[at])
    return str(correlation.index[i]), str(correlation.index[k]), float(matrix[i, k])


def gap(one: tuple[float, float], other: tuple[float, float]) -> float:
    """Return the distance of two ranges, 0 where they overlap.

    >>> gap((0.0, 0.25), (0.75, 1.0)), gap((0.0, 0.5), (0.25, 1.0))
    (0.5, 0.0)
    """
    return max(0.0, other[0] - one[1], one[0] - other[1])
