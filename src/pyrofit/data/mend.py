"""What is read over in the text of a file that a study would have to correct first."""

from collections.abc import Sequence
from dataclasses import replace

from pyrofit.data.csvheading import Line, is_number

ABSENT = frozenset({"nan", "#n/a", "n/a", "na", "#value!", "#div/0!", "null", "inf", "-inf"})
"""Words, in lower case, for a cell without a value."""
_BOM = b"\xef\xbb\xbf"
_RUN = 5
"""Rows of numbers in succession that are taken as the beginning of the table."""
_HEADING = 2


def decoded(data: bytes, notes: list[str]) -> str:
    """Return the text of a file; note an encoding that is not UTF-8, and a byte-order mark."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        notes.append(f"not UTF-8 (line {line}): read as cp1252")
        return data.decode("cp1252", errors="replace")
    if data.startswith(_BOM):
        notes.append("byte-order mark")
    return text


def mended_lines(lines: Sequence[Line], notes: list[str]) -> list[Line]:
    """Return header and rows of numbers alone, cells without a value empty.

    Rows before the header, words for cells without a value, and rows at the end whose first cell
    is empty are taken away, and noted.

    Examples
    --------
    >>> notes: list[str] = []
    >>> text = ["Test: 7", "Time,Mass", "0,5", "1,5", "2,NaN", "3,4", "4,4", "#N/A,4"]
    >>> lines = [Line(i, row.split(",")) for i, row in enumerate(text, start=1)]
    >>> [line.cells for line in mended_lines(lines, notes)][2:]
    [['1', '5'], ['2', ''], ['3', '4'], ['4', '4']]
    >>> notes
    ['1 rows before the header', "2 cells hold '#N/A' or 'NaN'", '1 rows at the end without a time']
    """
    kept = _without_preamble(lines, notes)
    words: dict[str, int] = {}
    for i, line in enumerate(kept):
        absent = [cell for cell in line.cells if cell.casefold() in ABSENT]
        for word in absent:
            words[word] = words.get(word, 0) + 1
        if absent:
            cells = ["" if cell.casefold() in ABSENT else cell for cell in line.cells]
            kept[i] = replace(line, cells=cells)
    if words:
        given = " or ".join(f"'{word}'" for word in sorted(words))
        notes.append(f"{sum(words.values())} cells hold {given}")
    whole = len(kept)
    while len(kept) > _HEADING and not any(kept[-1].cells[:1]):
        kept.pop()
    if len(kept) < whole:
        notes.append(f"{whole - len(kept)} rows at the end without a time")
    return kept


def _without_preamble(lines: Sequence[Line], notes: list[str]) -> list[Line]:
    """Return the lines from the header on; the header is the text right above rows of numbers."""
    start = next(
        (i for i in range(len(lines)) if all(map(_is_row, lines[i : i + _RUN]))), len(lines)
    )
    if start == len(lines):
        return list(lines)
    first = start
    while first > max(start - _HEADING, 0) and _is_heading(lines[first - 1], lines[start:]):
        first -= 1
    if first in (0, start):
        return list(lines)
    notes.append(f"{first} rows before the header")
    return list(lines[first:])


def _is_row(line: Line) -> bool:
    """Tell whether a line is a row of numbers: two or more cells, no words in them."""
    filled = [cell for cell in line.cells if cell and cell.casefold() not in ABSENT]
    return len(line.cells) > 1 and bool(filled) and all(map(is_number, filled))


def _is_heading(line: Line, rows: Sequence[Line]) -> bool:
    """Tell whether a line is text that fills the columns of the rows below it."""
    filled = [cell for cell in line.cells if cell]
    wanted = len([cell for cell in rows[0].cells if cell])
    return len(filled) >= wanted and not any(map(is_number, filled))
