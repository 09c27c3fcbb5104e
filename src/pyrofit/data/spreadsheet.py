"""Tables of spreadsheets as text, by the optional package `python-calamine`."""

import io
import zipfile
from collections.abc import Iterable, Sequence
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

from pyrofit.data.numerals import is_numeral
from pyrofit.errors import DataError

STARTS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
"""First bytes of a spreadsheet: a ZIP file, an old binary one."""
ENDINGS = frozenset({".xls", ".xlsx", ".xlsm", ".xlsb", ".ods"})
LARGEST_BYTES = 500_000_000
"""Largest size of an unpacked spreadsheet."""
_FEWEST_ROWS = 3


def is_spreadsheet(path: Path, data: bytes) -> bool:
    """Tell whether a file is a spreadsheet by its ending and its first bytes."""
    return path.suffix.casefold() in ENDINGS and data.startswith(STARTS)


def text_of_spreadsheet(path: Path, data: bytes, notes: list[str]) -> str:
    """Return the first sheet with rows of numbers, as text with tabs; note other such sheets.

    Parameters
    ----------
    path, data
        The file and its content.
    notes
        Where a note is added.

    Raises
    ------
    DataError
        The package that reads spreadsheets is not installed, the file is damaged, has a password or
        is too large, or no sheet has a table.
    """
    try:
        import python_calamine
    except ImportError:
        raise DataError(
            f"{path}: this is a spreadsheet, no text; `pip install python-calamine` lets pyrofit "
            "read it. Or save the sheet with the table as CSV."
        ) from None
    _check_size(path, data)
    try:
        book = python_calamine.CalamineWorkbook.from_filelike(io.BytesIO(data))
        sheets = {
            name: book.get_sheet_by_name(name).to_python(skip_empty_area=False)
            for name in book.sheet_names
        }
    except python_calamine.CalamineError as error:
        raise DataError(
            f"{path}: this spreadsheet cannot be read ({error}); save the sheet with the table as "
            "CSV, without a password."
        ) from None
    found = [name for name, rows in sheets.items() if _holds_table(rows)]
    if not found:
        raise DataError(
            f"{path}: no sheet of this spreadsheet ({', '.join(sheets)}) holds rows of numbers; "
            "give the file with the table."
        )
    notes.append(f"read from the sheet '{found[0]}' of a spreadsheet")
    if others := found[1:]:
        notes.append(f"further sheets with tables are not read: {', '.join(others)}")
    return lines_of(sheets[found[0]])


def lines_of(rows: Iterable[Sequence[Any]]) -> str:
    """Return rows of cells as text: tabs between the cells, numbers with all their digits.

    >>> lines_of([["Time (s)", "Mass (%)"], [0.5, 100.0]]).split()
    ['Time', '(s)', 'Mass', '(%)', '0.5', '100.0']
    """
    return "\n".join("\t".join(map(_cell, row)) for row in rows)


def _cell(value: Any) -> str:
    """Return the text of a cell; times of a clock as hours, minutes and seconds."""
    if isinstance(value, timedelta):
        seconds = value.total_seconds()
        whole = int(seconds)
        return f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{seconds - whole + whole % 60:06.3f}"
    if isinstance(value, datetime):
        return value.isoformat(" ", "milliseconds")
    if isinstance(value, time):
        return value.isoformat("milliseconds")
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, (float, int)):
        return repr(value)
    return " ".join(str(value).split())


def _holds_table(rows: Sequence[Sequence[Any]]) -> bool:
    """Tell whether three rows hold at least two numbers each."""
    full = 0
    for row in rows:
        full += sum(is_numeral(cell) for cell in map(_cell, row) if cell) > 1
        if full >= _FEWEST_ROWS:
            return True
    return False


def _check_size(path: Path, data: bytes) -> None:
    """Refuse a file that grows beyond the largest size when it is unpacked."""
    if not data.startswith(STARTS[0]):
        return
    try:
        size = sum(part.file_size for part in zipfile.ZipFile(io.BytesIO(data)).infolist())
    except zipfile.BadZipFile:
        raise DataError(
            f"{path}: this spreadsheet is damaged; save the sheet with the table as CSV."
        ) from None
    if size > LARGEST_BYTES:
        raise DataError(
            f"{path}: {size / 1e6:,.0f} MB when unpacked; spreadsheets of at most "
            f"{LARGEST_BYTES / 1e6:,.0f} MB are read. Save the sheet with the table as CSV."
        )
