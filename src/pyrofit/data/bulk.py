"""Read the numbers of a large file in one piece."""

import io
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd

from pyrofit.data.line import BLANKS
from pyrofit.data.numerals import Numerals

FloatArray = npt.NDArray[np.float64]
_ABSENT = ["", "NaN", "nan", "NA", "N/A", "#N/A"]


def bulk_values(
    rows: Sequence[str], delimiter: str, numerals: Numerals, width: int
) -> FloatArray | None:
    """Return the numbers of the lines of a table, shape (n_rows, width).

    None is returned where a line has another number of cells, or a cell holds other text than a
    finite number. The lines are then to be read one by one. The numbers are the same.
    """
    if numerals.thousands or not _are_alike(rows, delimiter, width):
        return None
    text = "\n".join(rows)
    try:
        frame = pd.read_csv(
            io.StringIO(text),
            sep=r"\s+" if delimiter == BLANKS else delimiter,
            header=None,
            dtype=np.float64,
            decimal=numerals.decimal,
            keep_default_na=False,
            na_values=_ABSENT,
            skip_blank_lines=False,
            skipinitialspace=True,
        )
    except (ValueError, pd.errors.ParserError):
        return None
    values = frame.to_numpy()
    if len(values) != len(rows) or np.isinf(values).any() or not np.isnan(values[:, width:]).all():
        return None
    return np.ascontiguousarray(values[:, :width])


def _are_alike(rows: Sequence[str], delimiter: str, width: int) -> bool:
    """Tell whether all lines have as many cells, and every quoted one ends in its line."""
    if delimiter == BLANKS:
        return all(len(row.split()) == width and '"' not in row for row in rows)
    separators = rows[0].count(delimiter)
    return separators >= width - 1 and all(
        row.count(delimiter) == separators and row.count('"') % 2 == 0 for row in rows
    )
