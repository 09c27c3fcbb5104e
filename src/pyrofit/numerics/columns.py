"""Matrices whose columns are zero outside one stretch of rows each, without most of the zeros."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from pyrofit.numerics.functions import Floats


@dataclass(frozen=True, eq=False)
class Columns:
    """Derivatives by parameters that move a part of the points each.

    Parameters
    ----------
    rows
        Number of rows.
    first
        First row of the stretch of each column, shape (columns,).
    ends
        End of each column in ``values``, after a zero, shape (columns + 1,).
    values
        The stretches one after the other.
    """

    rows: int
    first: NDArray[np.int64]
    ends: NDArray[np.int64]
    values: Floats

    @classmethod
    def of(cls, dense: Floats) -> "Columns":
        """Return the columns of a matrix, shape (rows, columns).

        >>> Columns.of(np.array([[0.0, 1.0], [2.0, 0.0], [3.0, 0.0]])).values.tolist()
        [2.0, 3.0, 1.0]
        """
        rows, count = dense.shape
        there = dense != 0.0
        some = there.any(axis=0)
        first = np.where(some, there.argmax(axis=0), 0)
        last = np.where(some, rows - there[::-1].argmax(axis=0), 0)
        ends = np.concatenate([[0], np.cumsum(last - first)])
        parts = [dense[first[k] : last[k], k] for k in range(count)]
        values = np.concatenate(parts) if parts else np.zeros(0)
        return cls(rows, first, ends, values)

    @property
    def dense(self) -> Floats:
        """The matrix, shape (rows, columns), a new array.

        >>> Columns.of(np.array([[0.0, 1.0], [2.0, 0.0]])).dense.tolist()
        [[0.0, 1.0], [2.0, 0.0]]
        """
        found = np.zeros((self.rows, self.first.size))
        for k, (begin, end) in enumerate(pairwise(self.ends.tolist())):
            found[self.first[k] : self.first[k] + end - begin, k] = self.values[begin:end]
        return found
