"""How a file writes numbers: decimal sign, separators of thousands, times of day, no value."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import date

from pyrofit.data.line import FileLine

ABSENT = frozenset({"nan", "#n/a", "n/a", "na", "#value!", "#div/0!", "null", "-", "--", "none"})
"""Words, in lower case, for a cell without a value."""
_CLOCK = re.compile(
    r"(?:(?P<date>\d{4}-\d\d?-\d\d?|\d\d?\.\d\d?\.\d{4})[T ]+)?"
    r"(?P<h>\d+):(?P<m>[0-5]?\d):(?P<s>[0-5]?\d(?:[.,]\d+)?) ?(?P<half>[AaPp][Mm])?"
)
_GROUPED = re.compile(r"[-+]?[1-9]\d{0,2}(?:[ '’\u00a0\u202f]\d{3})+(?:[.,]\d*)?")
_COMMAS = re.compile(r"[-+]?\d[\d.]*(?:,\d+)*(?:\.\d*)?(?:[eE][-+]?\d+)?")
_COMMA_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(?:,\d{3})+(?:\.\d*)?")
_POINT_THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(?:\.\d{3})+(?:,\d*)?")


@dataclass(frozen=True)
class Numerals:
    """Decimal sign and separator of thousands; the latter may be nothing."""

    decimal: str = "."
    thousands: str = ""

    def number(self, cell: str) -> float | None:
        """Return the number that a cell writes; None where it writes none.

        >>> Numerals(",", ".").number("1.234,5"), Numerals().number("4,999")
        (1234.5, None)
        """
        cell = cell.replace("\u2212", "-")
        if _GROUPED.fullmatch(cell):
            cell = re.sub(r"[ '’\u00a0\u202f]", "", cell)
        shape = _COMMA_THOUSANDS if self.thousands == "," else _POINT_THOUSANDS
        if self.thousands and self.thousands in cell:
            if not shape.fullmatch(cell):
                return None
            cell = cell.replace(self.thousands, "")
        if self.decimal == ",":
            if "." in cell:
                return None
            cell = cell.replace(",", ".")
        value = as_float(cell)
        return value if value is not None and math.isfinite(value) else None


PLAIN = Numerals()


def as_float(cell: str) -> float | None:
    """Return the number of a cell with a decimal point, infinity included; None where none."""
    try:
        value = float(cell)
    except ValueError:
        return None
    return None if "_" in cell or math.isnan(value) else value


def seconds_of_text(cell: str) -> float | None:
    """Return the seconds of a time hh:mm:ss; None where a cell is none.

    AM or PM may stand behind it, and before it a date whose day is clear.

    >>> [seconds_of_text(t) for t in ("1:02:03.5", "12:30", "12:00:01 AM", "1:00:00 pm")]
    [3723.5, None, 1.0, 46800.0]
    >>> seconds_of_text("2024-05-17 00:00:10") - seconds_of_text("16.05.2024 23:59:50")
    20.0
    >>> seconds_of_text("1/2/2024 1:00:00")
    """
    match = _CLOCK.fullmatch(cell)
    if match is None:
        return None
    hours, half = int(match["h"]), (match["half"] or "").casefold()
    if half:
        hours = hours % 12 + (12 if half == "pm" else 0)
    of_day = 3600.0 * hours + 60.0 * int(match["m"]) + float(match["s"].replace(",", "."))
    if match["date"] is None:
        return of_day
    numbers = [int(part) for part in re.split(r"[-.]", match["date"])]
    year, month, day = numbers if numbers[0] > 31 else numbers[::-1]
    try:
        return 86_400.0 * date(year, month, day).toordinal() + of_day
    except ValueError:
        return None


def of_parts(cell: str, unit: str) -> str:
    """Return a time of two parts, mm:ss or hh:mm, as hh:mm:ss; any other cell as it is.

    >>> of_parts("75:30.5", "mm:ss"), of_parts("23:05", "hh:mm"), of_parts("1:02:03", "mm:ss")
    ('01:15:30.5', '23:05:00', '1:02:03')
    """
    match = re.fullmatch(r"(\d+):(\d\d(?:[.,]\d+)?)", cell)
    if match is None:
        return cell
    if unit == "hh:mm":
        return f"{cell}:00"
    hours, minutes = divmod(int(match[1]), 60)
    return f"{hours:02d}:{minutes:02d}:{match[2]}"


def is_dated(cell: str) -> bool:
    """Tell whether a cell is a time with a date."""
    match = _CLOCK.fullmatch(cell)
    return match is not None and match["date"] is not None


def is_numeral(cell: str) -> bool:
    """Tell whether a cell writes a number or time in any way that is read, or has no value."""
    return (
        as_float(cell) is not None
        or cell.casefold() in ABSENT
        or bool(_COMMAS.fullmatch(cell) or _GROUPED.fullmatch(cell) or _CLOCK.fullmatch(cell))
    )


def numerals_of(rows: Iterable[FileLine]) -> Numerals:
    """Tell the decimal sign and the separator of thousands from all rows of a table.

    Numbers with commas that can be read in two ways, or that contradict others, are none: with
    decimal points they hold no number.

    >>> [numerals_of([FileLine(1, [c])]).decimal for c in ("4.5", "4,5", "4,999")]
    ['.', ',', '.']
    >>> numerals_of([FileLine(1, ["4,999", "1,234.5"])]).thousands
    ','
    """
    commas: list[str] = []
    points: list[str] = []
    for cell in (cell for row in rows for cell in row.cells):
        if "," in cell and _COMMAS.fullmatch(cell):
            commas.append(cell)
        elif "." in cell and as_float(cell) is not None:
            points.append(cell)
    decimal = any(not _COMMA_THOUSANDS.fullmatch(c) for c in commas)
    thousands = any(
        _COMMA_THOUSANDS.fullmatch(c) and ("." in c or c.count(",") > 1) for c in commas
    )
    if decimal and not thousands:
        grouped = any("." in cell and _POINT_THOUSANDS.fullmatch(cell) for cell in commas)
        if all(grouped and _POINT_THOUSANDS.fullmatch(point) for point in points):
            return Numerals(",", "." if grouped else "")
    return Numerals(".", ",") if thousands and not decimal else PLAIN


def fault_of(cell: str) -> str:
    """Say why a cell holds no number, and how to correct it.

    >>> fault_of("4,999")[:49]
    'it may be 4.999, with a decimal comma, or 4999, w'
    """
    if _COMMA_THOUSANDS.fullmatch(cell):
        return (
            f"it may be {cell.replace(',', '.')}, with a decimal comma, or "
            f"{cell.replace(',', '')}, with a separator of thousands, and nothing in the file "
            "tells which. Write numbers with decimal points and without separators of thousands."
        )
    if _COMMAS.fullmatch(cell) and "," in cell:
        return (
            "other numbers of the file have a decimal point; all need the same decimal sign. "
            "Write points, and no separators of thousands."
        )
    return (
        "each cell must be a finite number, or empty where there is no value. Correct the cell or "
        "delete its row."
    )
