"""The rows of a table: from the lines of a file to numbers."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from pyrofit.data.csvheading import Heading, holds_units, ragged, trim
from pyrofit.data.layout import Layout, cells_of
from pyrofit.data.line import FileLine
from pyrofit.data.numerals import ABSENT, Numerals, is_dated, is_numeral, seconds_of_text
from pyrofit.errors import DataError

FloatArray = npt.NDArray[np.float64]
_FEWEST_ROWS = 3
_DAY_S = 86_400.0
_MOST_TEXTS = 20
"""Texts of a column that are kept."""


def rows_of(path: Path, raw: Sequence[str], layout: Layout) -> list[FileLine]:
    """Return the lines of numbers of a file, as cells."""
    return [
        FileLine(i, cells_of(path, text, layout.delimiter))
        for i, text in enumerate(raw[layout.start :], start=layout.start + 1)
    ]


def without_footer(path: Path, raw: list[str], layout: Layout, notes: list[str]) -> list[str]:
    """Return the lines of a file without text below the rows of numbers.

    Such text is a row at the end whose first cell is empty or text, where the first row begins with
    a number. It is also a shorter row that holds text.
    """
    end = len(raw)
    width = len(cells_of(path, raw[layout.start], layout.delimiter))
    if not _is_of_numbers(path, raw[layout.start], layout, width):
        return raw
    while end > layout.start + _FEWEST_ROWS:
        if _is_of_numbers(path, raw[end - 1], layout, width):
            break
        end -= 1
    left = [text for text in raw[end:] if cells_of(path, text, layout.delimiter)]
    if left:
        notes.append(f"{len(left)} rows at the end that begin with no number")
    return raw[:end]


def _is_of_numbers(path: Path, text: str, layout: Layout, width: int) -> bool:
    """Tell whether a line begins with a number, and is whole or holds no text."""
    cells = cells_of(path, text, layout.delimiter)
    first = cells[0] if cells else ""
    if not first or not is_numeral(first) or first.casefold() in ABSENT:
        return False
    return len(cells) >= width or all(is_numeral(cell) for cell in cells if cell)


def whole_rows(
    path: Path, rows: Sequence[FileLine], heading: Heading, marks: bool, notes: list[str]
) -> list[FileLine]:
    """Return the rows, each as wide as the header.

    Rows that repeat the header are left out, with text right above them and units below. Where
    there are ``marks``, so are rows that mark an event by a negative number in the first column.

    Raises
    ------
    DataError
        A row is blank, or longer or shorter than the header.
    """
    width = len(heading.names)
    whole: list[FileLine] = []
    text: list[FileLine] = []  # rows without a number, which a header may follow
    headers = events = 0
    for row in rows:
        cells = trim(row.cells, width)
        if repeats(cells, heading):
            headers += 1
            text = []
        elif not any(is_numeral(cell) for cell in cells if cell):
            # Right below a header that stands again are its units.
            if not (headers and not text and _are_units(cells)):
                text.append(FileLine(row.number, cells))
        elif text:
            break
        elif len(cells) != width:
            raise ragged(path, row.number, len(cells), width)
        elif marks and cells[0].startswith("-"):
            events += 1
        else:
            whole.append(FileLine(row.number, cells))
    if text:
        raise _interrupted(path, text[0], width)
    if not whole:
        raise DataError(f"{path}: no row of numbers stands below the header; give a longer file.")
    counts = {"that repeat the header": headers, "that mark events": events}
    notes += [f"{count} rows {why}" for why, count in counts.items() if count]
    return whole


def _interrupted(path: Path, row: FileLine, width: int) -> DataError:
    """Return the error of a row without numbers among the others."""
    if len(row.cells) != width and any(row.cells):
        return ragged(path, row.number, len(row.cells), width)
    what = f"holds text, {row.cells}" if any(row.cells) else "is blank but numbers follow"
    return DataError(f"{path}, line {row.number}: this row {what}; delete it.")


def repeats(cells: Sequence[str], heading: Heading) -> bool:
    """Tell whether a row holds the names of the columns."""
    if len(cells) != len(heading.names):
        return False
    pairs = zip((cell.lstrip("#") for cell in cells), heading.names, heading.given, strict=True)
    return all(
        bool(cell) and (cell.startswith(name) or name.startswith(cell))
        for cell, name, named in pairs
        if named
    )


def _are_units(cells: list[str]) -> bool:
    return holds_units(FileLine(0, cells))


def parsed(
    rows: Sequence[FileLine], width: int, numerals: Numerals, notes: list[str]
) -> tuple[FloatArray, dict[int, dict[str, int]]]:
    """Return the numbers, and the texts of each column that holds some, with their first lines.

    A column of times hh:mm:ss is read in seconds. Words such as `NaN` hold no value, and are noted.
    """
    values = np.full((len(rows), width), np.nan)
    texts: dict[int, dict[str, int]] = {}
    absent: list[str] = []
    for i in range(width):
        clock = seconds_of_text(rows[0].cells[i]) is not None
        read = seconds_of_text if clock else numerals.number
        for j, row in enumerate(rows):
            cell = row.cells[i]
            number = read(cell) if cell else None
            if number is not None:
                values[j, i] = number
            elif cell and cell.casefold() not in ABSENT:
                of_column = texts.setdefault(i, {})
                if len(of_column) < _MOST_TEXTS:
                    of_column.setdefault(cell, row.number)
            elif cell:
                absent.append(cell)
        if clock and is_dated(rows[0].cells[i]):
            values[:, i] -= values[0, i]
        elif clock:
            notes += _past_midnight(values[:, i], rows)
    if absent:
        words = " or ".join(f"'{word}'" for word in sorted(set(absent)))
        notes.append(f"{len(absent)} cells hold {words}")
    return values, texts


def _past_midnight(times: FloatArray, rows: Sequence[FileLine]) -> list[str]:
    """Count times of day on past midnight, from the first row on; return a note on each."""
    passed = np.flatnonzero(np.diff(times) < -0.5 * _DAY_S) + 1
    if not passed.size:
        return []
    for row in passed:
        times[row:] += _DAY_S
    times -= times[0]
    where = ", ".join(str(rows[int(row)].number) for row in passed)
    return [f"the time of day passes midnight at line {where}; times count from the first row"]
