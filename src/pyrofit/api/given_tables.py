"""Series in memory as tables: those that a caller gives as tables, arrays or tuples of columns."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.errors import DataError
from pyrofit.quantities.base import Quantity

_LINE = re.compile(r"\bline (\d+)\b")


def named_in_memory(text: str, labels: Mapping[str, str]) -> str:
    """Return a message that names series in memory instead of the files they were written to.

    Lines of such a file, below its header, become indices from 0.

    >>> print(named_in_memory("x/a.csv, line 12: given 'x'", {"x/a.csv": "data of a"}))
    data of a, index 10: given 'x'
    """
    lines = text.splitlines()
    for i, line in enumerate(lines):
        for path, label in labels.items():
            if path in line:
                lines[i] = line = indexed(line.replace(path, label))
    return "\n".join(lines)


def indexed(text: str) -> str:
    """Return a message on a series in memory, with indices instead of lines of a file."""
    return _LINE.sub(lambda line: f"index {int(line[1]) - 2}", text)


def as_table(given: Any, quantity: Quantity, label: str) -> pd.DataFrame:
    """Return a caller's data as a table.

    Parameters
    ----------
    given
        A table as it is. An array of the columns time [s], temperature [K] of heated samples,
        value, and maybe uncertainty, in SI units. That of a heated sample may be temperature and
        value alone. A tuple of such columns.
    quantity
        The measured quantity.
    label
        What the data are, for messages.

    Raises
    ------
    DataError
        They are no numbers, or have another number of columns.
    """
    if isinstance(given, pd.DataFrame):
        return given
    try:
        columns = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise DataError(f"{label}: neither a table nor an array of numbers") from None
    if isinstance(given, tuple):
        columns = columns.T
    names = ["time_s", *(["temperature_K"] if quantity.against_temperature else [])]
    names += [quantity.column, quantity.uncertainty_column]
    if quantity.against_temperature and columns.ndim == 2 and columns.shape[1] == 2:
        names = names[1:]
    if columns.ndim != 2 or columns.shape[1] not in (len(names) - 1, len(names)):
        raise DataError(
            f"{label}: an array of the shape {columns.shape}; its columns must be "
            f"{', '.join(names)}, of which the last may be left out"
        )
    return pd.DataFrame(columns, columns=names[: columns.shape[1]])
