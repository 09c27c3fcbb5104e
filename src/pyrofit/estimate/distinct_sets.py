"""Parameter sets that agree in all that an experiment depends on."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from pyrofit.solver.arrays import Value, Values

Indices = NDArray[np.int64]


def distinct_sets(columns: Sequence[Value], sets: int) -> tuple[Indices, Indices]:
    """Return the first of equal sets, and the position among these of every set.

    Parameters
    ----------
    columns : numbers, each alone or of shape (sets,).

    Examples
    --------
    >>> first, of_set = distinct_sets([1.0, np.array([3.0, 2.0, 3.0])], 3)
    >>> first.tolist(), of_set.tolist()
    ([0, 1], [0, 1, 0])
    """
    every = np.arange(sets)
    rows = [column for column in columns if isinstance(column, np.ndarray)]
    if sets == 1 or not rows:
        return every[:1], np.zeros(sets, dtype=np.int64)
    known: dict[bytes, int] = {}
    table = np.array(rows).T.copy()
    of_set = np.array([known.setdefault(one.tobytes(), len(known)) for one in table])
    return np.unique(of_set, return_index=True)[1], of_set


def taken(values: Values, first: Indices, sets: int) -> Values:
    """Return the values of some sets; of one set as numbers."""
    if first.size == sets:
        return values
    one = first.size == 1
    return {
        name: value
        if not isinstance(value, np.ndarray)
        else float(value[first[0]])
        if one
        else value[first]
        for name, value in values.items()
    }
