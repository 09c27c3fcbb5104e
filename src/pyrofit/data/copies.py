"""Series of two tests that hold the same numbers: a file that was copied or exported twice."""

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import FloatArray

RUN = 12
"""Values in succession that no two tests share by chance, where most of them differ."""
_WORDS = {"time_s": "time", "temperature_K": "temperature"}


@dataclass(frozen=True)
class Copy:
    """A series that begins, or ends, with the values of one before it.

    Parameters
    ----------
    position, of
        Of the series, and of the one before it, among all.
    same, size, of_size
        Values that are the same in succession, of how many, and of how many of the other.
    end
        'first' or 'last'.
    """

    position: int
    of: int
    same: int
    size: int
    of_size: int
    end: str

    @property
    def whole(self) -> bool:
        """Whether all values of both are the same."""
        return self.same == self.size == self.of_size

    @property
    def most(self) -> bool:
        """Whether most values of the shorter one are the same."""
        return 2 * self.same > min(self.size, self.of_size)

    @property
    def words(self) -> str:
        """How many values are the same.

        >>> Copy(1, 0, 20, 30, 40, "first").words
        'the first 20 of 30 values'
        """
        return f"all {self.same} values" if self.whole else f"the {self.end} {self.count}"

    @property
    def count(self) -> str:
        """The number of values that are the same, of all."""
        return f"{self.same} of {self.size} values"


def copies(series: Sequence[tuple[Hashable, FloatArray]]) -> Iterator[Copy]:
    """Yield the series that have the values of one before them, at the start or at the end.

    Parameters
    ----------
    series
        What is measured, and the values; only series of one and the same thing are compared.

    Examples
    --------
    >>> y = np.sqrt(np.arange(40.0))
    >>> [found.words for found in copies([("mass", y), ("mass", y[:38]), ("heat", y)])]
    ['the first 38 of 38 values']
    """
    known: dict[tuple[Hashable, ...], int] = {}
    for i, (of, y) in enumerate(series):
        if y.size < 3 * RUN:
            continue
        for end, run in (("first", y[:RUN]), ("last", y[-RUN:])):
            if np.unique(run).size < RUN - 4:
                continue
            j = known.setdefault((of, end, *run.tolist()), i)
            if j != i:
                yield _copy(i, j, y, series[j][1], end)


def _copy(i: int, j: int, y: FloatArray, other: FloatArray, end: str) -> Copy:
    mine, theirs = (y, other) if end == "first" else (y[::-1], other[::-1])
    size = min(mine.size, theirs.size)
    differ = np.flatnonzero(mine[:size] != theirs[:size])
    return Copy(i, j, int(differ[0]) if differ.size else size, y.size, other.size, end)


def is_copy(found: Copy, frame: pd.DataFrame, other: pd.DataFrame) -> bool:
    """Tell whether the times of these rows are the same as well, as in a file that was copied."""
    return _WORDS["time_s"] in columns_alike(found, frame, other)


def columns_alike(found: Copy, frame: pd.DataFrame, other: pd.DataFrame) -> list[str]:
    """Return in words the columns besides the values that are the same over these rows."""
    rows = slice(None, found.same) if found.end == "first" else slice(-found.same, None)
    return [
        words
        for name, words in _WORDS.items()
        if name in frame and name in other and np.array_equal(frame[name][rows], other[name][rows])
    ]
