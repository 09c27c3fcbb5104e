"""Rows of a file in which a quantity was not recorded."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pyrofit.data.csvfile import FileTable
from pyrofit.errors import DataError

_ABSCISSAE = ("time", "temperature")
_SHORT = 0.01
"""Share of a record that a beginning before time 0 may have."""
_FEW = 0.1
"""Share of rows of the time of the row before that are left out; more are refused."""


def without_gaps(table: FileTable, headers: Mapping[str, str]) -> tuple[FileTable, list[str]]:
    """Leave out the rows in which the value or its uncertainty has an empty cell.

    A file may hold quantities that were recorded at different intervals. Empty cells of columns
    that are not read do not matter.

    Parameters
    ----------
    table : Table
        The file.
    headers : mapping of str to str
        Columns that are read, by role.

    Returns
    -------
    Table, list of str
        The rows that are left, and a note on those that are not.

    Raises
    ------
    DataError
        A cell of the time or the temperature is empty.
    """
    empty = {role: np.isnan(table.columns[header]) for role, header in headers.items()}
    for role in _ABSCISSAE:
        if role in empty and empty[role].any():
            raise DataError(
                f"{table.path}, line {table.line(int(empty[role].argmax()))}, column "
                f"'{headers[role]}': given an empty cell or NaN; every row needs its {role}. "
                "Complete the row or delete it."
            )
    gaps = np.any(list(empty.values()), axis=0)
    if not gaps.any():
        return table, []
    left = replace(
        table,
        columns={name: column[~gaps] for name, column in table.columns.items()},
        left_out=tuple(np.flatnonzero(gaps).tolist()),
    )
    return left, [f"left out, without a value: {gaps.sum()} of {gaps.size} rows"]


def without_doubles(table: FileTable, header: str) -> tuple[FileTable, list[str]]:
    """Leave out the second of two rows of one time, where few rows are so; note them."""
    time = table.columns[header]
    double = np.r_[False, np.diff(time) == 0.0]
    if not double.any() or double.sum() > _FEW * time.size:
        return table, []
    first = table.line(int(double.argmax()))
    left = _without(table, double)
    return left, [f"left out, the time of the row before: {double.sum()} rows, first line {first}"]


def without_times_before(table: FileTable, header: str) -> tuple[FileTable, list[str]]:
    """Leave out the few rows before time 0 at the start of a record; note them."""
    time = table.columns[header]
    before = np.logical_and.accumulate(time < 0.0)
    if not before.any() or before.all() or time[0] < -_SHORT * time[-1]:
        return table, []
    return _without(table, before), [f"left out, before time 0: {before.sum()} rows"]


def _without(table: FileTable, out: NDArray[np.bool_]) -> FileTable:
    """Return a table without some of its rows."""
    every = np.arange(out.size + len(table.left_out))
    kept = np.delete(every, table.left_out)[~out]
    return replace(
        table,
        columns={name: column[~out] for name, column in table.columns.items()},
        left_out=tuple(np.setdiff1d(every, kept).tolist()),
    )


def without_stops(table: FileTable, header: str) -> tuple[FileTable, list[str]]:
    """Leave out the rows whose temperature is not above all before: a record without times.

    Returns
    -------
    Table, list of str
        The rows that are left, and a note.

    Raises
    ------
    DataError
        The temperature does not rise over most of the rows.
    """
    column = table.columns[header]
    rising = np.r_[True, column[1:] > np.maximum.accumulate(column)[:-1]]
    if 2 * rising.sum() < rising.size:
        raise DataError(
            f"{table.path}, column '{header}': without times the temperature must rise from row to "
            f"row, and it does so in {rising.sum()} of {rising.size} only. Give a file with times."
        )
    note = ["no times: those of the constant heating rate"]
    if rising.all():
        return table, note
    left = _without(table, ~rising)
    return left, [*note, f"left out, the temperature does not rise: {(~rising).sum()} rows"]
