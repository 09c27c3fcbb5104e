"""Output of a program: columns of numbers, read by name or number, in SI units."""

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from pyrofit.data.convert import convert_columns
from pyrofit.data.csvfile import FileTable
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import suggest
from pyrofit.model.program import Reading
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import header_key
from pyrofit.solver.arrays import FloatArray

_FORTRAN = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))(?:[dD]([-+]?\d+)|([-+]\d{2,3}))")
FEWEST = 2
"""Smallest number of rows of a record."""


class WrittenCurve(NamedTuple):
    """A curve as a program has written it, SI units.

    Parameters
    ----------
    at
        Times [s] or temperatures [K], not decreasing, shape (rows,).
    value
        The values there, shape (rows,).
    """

    at: FloatArray
    value: FloatArray


class OutputError(Exception):
    """The output of a run cannot be read: the run has failed."""


def read_output(folder: Path, reading: Reading, quantity: Quantity) -> WrittenCurve:
    """Return the curve of a signal in the output of a run.

    Rows above the header and rows of units beside it are skipped. Commas, semicolons, tabs or
    blanks separate cells; numbers may have the exponents of Fortran.

    Parameters
    ----------
    folder
        Folder of the run.
    reading
        File, columns and units.
    quantity
        Quantity of the signal.

    Raises
    ------
    OutputError
        The file is missing, cut or has no such column; a cell is no finite number; time decreases.
    DataError
        A unit does not fit the quantity.
    """
    path = folder / reading.file
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        raise OutputError(f"{reading.file}: the program has not written it") from None
    except OSError as error:
        raise OutputError(f"{reading.file}: cannot be read ({error.strerror})") from None
    # A last row without its end may lack digits: it is left out.
    whole = text.rpartition("\n")[0]
    columns = _columns(reading, [line for line in whole.split("\n") if line.strip()])
    record = in_si(reading, quantity, columns)
    falls = np.flatnonzero(np.diff(record.at) < 0.0)
    if falls.size:
        raise OutputError(f"{reading.file}, row {falls[0] + 2} of numbers: time decreases")
    if reading.holds == "point":
        return record
    # A mean over an interval is the value in its middle.
    return WrittenCurve(0.5 * (record.at[1:] + record.at[:-1]), record.value[1:])


def in_si(reading: Reading, quantity: Quantity, columns: Mapping[str, FloatArray]) -> WrittenCurve:
    """Return the columns of a reading in SI units.

    Raises
    ------
    DataError
        A unit does not fit the quantity.
    """
    role = reading.abscissa
    spec = SeriesSpec(
        quantity.name,
        Path(reading.file),
        columns={},
        units={"time": "s", **{r: unit for r, unit in reading.units.items() if r in columns}},
        sample_mass_kg=reading.sample_mass_kg,
        sample_area_m2=reading.sample_area_m2,
    )
    given = {"time": np.arange(len(columns["value"]), dtype=np.float64), **columns}
    table = FileTable(Path(reading.file), given, dict.fromkeys(given), 1)
    frame, _ = convert_columns(spec, table, {name: name for name in given})
    at = frame["time_s" if role == "time" else "temperature_K"].to_numpy(float)
    value = frame[quantity.column].to_numpy(float)
    if role == "temperature":
        rising = np.concatenate([[True], np.diff(np.maximum.accumulate(at)) > 0.0])
        at, value = at[rising], value[rising]
    return WrittenCurve(at, value)


def _columns(reading: Reading, lines: Sequence[str]) -> dict[str, FloatArray]:
    """Return the numbers of the columns by role."""
    heads = reading.heads
    numbered = all(isinstance(head, int) for head in heads.values())
    if numbered:
        first = next((i for i, line in enumerate(lines) if _all_numbers(line)), len(lines))
        where = {role: int(head) - 1 for role, head in heads.items()}
        separator = _separator(lines[first]) if first < len(lines) else None
    else:
        first, where, separator = _header(reading, lines)
    rows = [_cells(line, separator) for line in lines[first:]]
    start = next((i for i, row in enumerate(rows[:3]) if _is_row(row, where)), 0)
    rows = rows[start:]
    if len(rows) < FEWEST:
        raise OutputError(f"{reading.file}: it holds {len(rows)} rows of numbers")
    found = {role: np.empty(len(rows)) for role in where}
    for n, row in enumerate(rows):
        for role, column in where.items():
            value = to_number(row[column]) if column < len(row) else math.nan
            if not math.isfinite(value):
                cut = "the last row is cut" if n == len(rows) - 1 else "no finite number"
                given = row[column] if column < len(row) else "nothing"
                raise OutputError(
                    f"{reading.file}, row {n + 1} of numbers, column '{heads[role]}': "
                    f"'{given}': {cut}"
                )
            found[role][n] = value
    return found


def _header(reading: Reading, lines: Sequence[str]) -> tuple[int, dict[str, int], str | None]:
    """Return the row below the header, the columns by role, and the separator of cells."""
    heads = reading.heads
    named = [head for head in heads.values() if isinstance(head, str)]
    seen: list[str] = []
    for i, line in enumerate(lines):
        separator = _separator(line)
        cells = _cells(line, separator)
        where = {role: _place(head, cells) for role, head in heads.items()}
        if all(place >= 0 for place in where.values()):
            return i + 1, where, separator
        if any(_place(head, cells) >= 0 for head in named) or (not seen and not _all_numbers(line)):
            seen = [cell for cell in cells if cell]
    missing = next((head for head in named if _place(head, seen) < 0), named[0])
    raise OutputError(f"{reading.file}: there is no column '{missing}'. {suggest(missing, seen)}")


def _place(head: str | int, cells: Sequence[str]) -> int:
    """Return the column of a header; -1 if there is none, or more than one."""
    if isinstance(head, int):
        return head - 1 if 1 <= head <= len(cells) else -1
    if cells.count(head) == 1:
        return cells.index(head)
    keys = [header_key(cell) for cell in cells]
    key = header_key(head)
    return keys.index(key) if keys.count(key) == 1 else -1


def _separator(line: str) -> str | None:
    """Return the separator of the cells of a line; None = blanks."""
    found = max(",;\t", key=line.count)
    return found if found in line else None


def _cells(line: str, separator: str | None) -> list[str]:
    return [cell.strip().strip("\"'").strip() for cell in line.split(separator)]


def _all_numbers(line: str) -> bool:
    cells = [cell for cell in _cells(line, _separator(line)) if cell]
    return bool(cells) and all(not math.isnan(to_number(cell)) for cell in cells)


def _is_row(row: Sequence[str], where: Mapping[str, int]) -> bool:
    return all(c < len(row) and not math.isnan(to_number(row[c])) for c in where.values())


def to_number(cell: str) -> float:
    """Return the number in a cell, as Fortran may write it; NaN if there is none.

    >>> to_number("1.5D-03"), to_number("0.1234-101"), to_number("*****")
    (0.0015, 1.234e-102, nan)
    """
    try:
        return float(cell)
    except ValueError:
        found = _FORTRAN.fullmatch(cell.strip())
        return float(f"{found[1]}e{found[2] or found[3]}") if found else math.nan
