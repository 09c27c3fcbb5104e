"""Find the table in the text of a file: its delimiter, its heading, its first row of numbers."""

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pyrofit.data.csvheading import all_bracketed, holds_names_with_units, is_number, trim
from pyrofit.data.heading_rows import heading_above, signals_in
from pyrofit.data.line import BLANKS, FileLine
from pyrofit.data.numerals import is_numeral
from pyrofit.errors import DataError

_DELIMITERS = "\t;,"
_ALL_DELIMITERS = (*_DELIMITERS, "|", BLANKS)
_SEARCHED = 3000
"""Lines in which the table begins at the latest."""
_RUN = 5
"""Rows of numbers in succession that are taken as the beginning of the table."""


@dataclass(frozen=True)
class Layout:
    """Where the table of a file is.

    Parameters
    ----------
    delimiter
        The separator of its cells.
    heading
        The row of names, and at most one of units.
    start
        Position of the first row of numbers among the lines of the file.
    marks
        Whether rows with a negative first number mark events.
    export
        Whether other text than names and units stands around the table.
    """

    delimiter: str
    heading: tuple[FileLine, ...]
    start: int
    marks: bool = False
    export: bool = False


def cells_of(path: Path, text: str, delimiter: str) -> list[str]:
    """Return the cells of a line.

    Raises
    ------
    DataError
        The line is not that of a delimited text file.
    """
    if delimiter == BLANKS:
        return text.split()
    try:
        cells = csv.reader([text], delimiter=delimiter, skipinitialspace=True)
        return [cell.strip() for cell in next(cells, [])]
    except csv.Error as error:
        line = f"a line of {len(text)} characters that begins with {text[:20]!r}"
        raise DataError(
            f"{path}: {line} cannot be split into cells ({error}); correct it, or delete it."
        ) from None


def usual_delimiter(path: Path, raw: Sequence[str]) -> str:
    """Return the delimiter that the first line with text has most.

    Raises
    ------
    DataError
        The file has no text.
    """
    header = next((line for line in raw if "".join(line.split()).strip(_DELIMITERS + '"')), None)
    if header is None:
        raise DataError(f"{path}: the file is empty; a header row and rows of numbers are needed.")
    if any(sign in header for sign in _DELIMITERS[:-1]):
        header = header.replace(", ", " ")  # as in "Time, s;Mass, %"
    return max(_DELIMITERS, key=header.count)


def layout_of(path: Path, raw: Sequence[str], notes: list[str]) -> Layout:
    """Return where the table is.

    A file that begins with one or two rows of text and goes on with rows as wide is such a table.
    Else the first run of rows of numbers is, with the text above it that fills its columns.

    Raises
    ------
    DataError
        There is no header, or there are no numbers.
    """
    delimiter = usual_delimiter(path, raw)
    lines = [
        FileLine(i, cells_of(path, t, delimiter)) for i, t in enumerate(raw[:_SEARCHED], start=1)
    ]
    filled = [line for line in lines if any(line.cells)]
    count = next((i for i, line in enumerate(filled) if any(map(is_number, line.cells))), -1)
    if _is_plain(filled, count) and _goes_on(filled[count : count + 2 * _RUN]):
        return Layout(delimiter, tuple(filled[:count]), filled[count].number - 1)
    located = _located(path, raw, notes)
    if located is not None:
        return located
    _refuse(path, filled, count)
    return Layout(delimiter, tuple(filled[:count]), filled[count].number - 1)


def _is_plain(filled: Sequence[FileLine], count: int) -> bool:
    """Tell whether one or two rows of text stand above rows of numbers that are as wide."""
    if count not in (1, 2):
        return False
    names = filled[1] if count == 2 and all_bracketed(filled[0]) else filled[0]
    width, row = len(trim(names.cells)), filled[count]
    wide = width == len(trim(row.cells, width)) and all(names.cells[:width]) and width > 1
    return wide and not (count == 2 and holds_names_with_units(filled[1]) and names is filled[0])


def _goes_on(rows: Sequence[FileLine]) -> bool:
    """Tell whether most of some lines are rows of numbers, and not keys with values."""
    if not is_numeral(next((cell for cell in rows[0].cells if cell), "")):
        return False
    width = len(trim(rows[0].cells))
    return 2 * sum(_is_row(r.cells) and len(trim(r.cells)) == width for r in rows) > len(rows)


def _refuse(path: Path, lines: Sequence[FileLine], count: int) -> None:
    """Refuse all but tables."""
    if count == 0:
        raise DataError(
            f"{path}, line {lines[0].number}: the first row holds numbers; "
            "a header row with the names of the columns must come first."
        )
    if count > 2:
        raise DataError(
            f"{path}, line {lines[2].number}: given text {lines[2].cells}; found no table of "
            "numbers. A row of names, and at most one of units, must stand right above them. "
            "Separate cells by comma, semicolon or tab, and give each column its name."
        )
    if count < 0:
        raise DataError(
            f"{path}: the file holds a header and no numbers; rows of numbers must follow it, "
            "their cells set apart by comma, semicolon or tab."
        )


def _located(path: Path, raw: Sequence[str], notes: list[str]) -> Layout | None:
    """Return the table that begins with the first run of rows of numbers; None without one."""
    best: tuple[int, str, int, list[FileLine]] = 0, "", 0, []
    for delimiter in _ALL_DELIMITERS:
        lines = [
            FileLine(i, cells_of(path, text, delimiter))
            for i, text in enumerate(raw[:_SEARCHED], 1)
        ]
        length, first = _first_run(lines)
        if length > best[0]:
            best = length, delimiter, first, lines
    length, delimiter, first, lines = best
    if not length:
        return None
    signals = signals_in(raw[:first])
    heading = signals or heading_above(lines, first, delimiter) or _of_count(lines, raw, first)
    if heading and heading[0].cells[1:2] == ["column 2"]:
        notes.append("no names of columns, but a count of rows, as Gpyro has")
        return Layout(delimiter, heading, first)
    if not heading:
        width = len(lines[first].cells)
        raise DataError(
            f"{path}, line {lines[first].number}: the numbers begin here, in {width} columns; a "
            "row with their names must stand right above them. If commas are both decimal signs "
            "and between columns, save the file with semicolons or with decimal points."
        )
    if before := sum(any(line.cells) for line in lines[: heading[0].number - 1]):
        notes.append(f"{before} rows before the header")
    return Layout(delimiter, heading, first, bool(signals), export=True)


def _of_count(lines: Sequence[FileLine], raw: Sequence[str], first: int) -> tuple[FileLine, ...]:
    """Return times and numbered columns where a count of the rows stands alone above them."""
    above = [line for line in lines[:first] if any(line.cells)]
    rows = sum(bool(text.strip()) for text in raw[first:])
    if len(above) != 1 or "".join(above[0].cells) != str(rows):
        return ()
    width = len(lines[first].cells)
    names = ["Time (s)", *(f"column {i}" for i in range(2, width + 1))]
    return (FileLine(above[0].number, names),)


def _first_run(lines: Sequence[FileLine]) -> tuple[int, int]:
    """Return length of the longest run of rows of one width, and where the first such run begins.

    A run has five rows; three where the file has no longer ones.
    """
    runs = list(_runs(lines))
    longest = max(runs, key=lambda run: run[0], default=(0, 0, 0))
    if longest[0] < 3:
        return 0, 0
    first = next(run for run in runs if run[2] == longest[2] and run[0] >= min(_RUN, longest[0]))
    start = first[1]
    while start and _is_gap(lines[start - 1].cells, longest[2]):
        start -= 1
    return longest[0], start


def _runs(lines: Sequence[FileLine]) -> Iterator[tuple[int, int, int]]:
    """Yield length, first line and width of each run of rows of numbers of one width."""
    start, width = 0, 0
    for i, line in enumerate([*lines, FileLine(0, [])]):
        wide = len(line.cells) if _is_row(line.cells) else 0
        if wide != width:
            if width:
                yield i - start, start, width
            start, width = i, wide


def _is_gap(cells: Sequence[str], width: int) -> bool:
    """Tell whether a line is a row of numbers with empty cells."""
    filled = [cell for cell in cells if cell]
    return len(cells) == width and bool(filled) and all(map(is_numeral, filled))


def _is_row(cells: Sequence[str]) -> bool:
    """Tell whether at least two of a line's cells, and at least half, are numbers."""
    filled = [cell for cell in cells if cell]
    numbers = sum(map(is_numeral, filled))
    return numbers >= 2 and 2 * numbers >= len(filled)
