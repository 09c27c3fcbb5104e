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

    None is returned where a line has another number of cells, or a cell is quoted or holds other
    text than a finite number. The lines are then to be read one by one. The numbers are the same.
    """
    if numerals.thousands or delimiter == BLANKS:
        return None
    separators = rows[0].count(delimiter)
    if separators < width - 1 or any(row.count(delimiter) != separators for row in rows):
        return None
    text = "\n".join(rows)
    if '"' in text:
        return None
    try:
        frame = pd.read_csv(
            io.StringIO(text),
            sep=delimiter,
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
