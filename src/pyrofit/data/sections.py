"""The first table of an export that holds more: titles of steps, other curves, text below."""

import re
from collections.abc import Collection, Sequence

from pyrofit.data.csvheading import Heading, holds_units, trim
from pyrofit.data.line import FileLine
from pyrofit.data.numerals import Numerals, as_float, is_numeral, seconds_of_text
from pyrofit.data.rows import repeats

_STEP = re.compile(r"\d+\)\s.*[A-Za-z].*")
"""Title of a step of a run, as Pyris writes it between the rows: `2) TGA Temperature Scan`."""
_BRACKETS = "[]() "
_TIME = re.compile(r"(time|t|zeit)\b.*", re.IGNORECASE)


def first_table(rows: Sequence[FileLine], heading: Heading, notes: list[str]) -> list[FileLine]:
    """Return the rows of the first table, without titles of steps and all that follows it.

    Rows below a header that stands again belong to it as well: steps of one run. They are another
    table if their units differ, or if their time begins anew. Text between rows of numbers stays
    for `pyrofit.data.rows.whole_rows` to refuse.
    """
    kept = [row for row in rows if not _is_title(row.cells)]
    end = _end(kept, heading, notes)
    if steps := len(rows) - len(kept):
        notes.append(f"{steps} rows that begin a step of the run")
    below = sum(any(row.cells) for row in kept[end:])
    if below:
        notes.append(f"{below} rows below the table are not read")
    return kept[:end]


def _is_title(cells: Sequence[str]) -> bool:
    """Tell whether a line is the title of a step."""
    filled = [cell for cell in cells if cell]
    return bool(_STEP.fullmatch(" ".join(filled))) and not all(map(is_numeral, filled))


def _end(rows: Sequence[FileLine], heading: Heading, notes: list[str]) -> int:
    """Return the position behind the last row of the first table."""
    width = len(heading.names)
    i = 0
    while i < len(rows):
        if not _is_gap(rows[i].cells):
            i += 1
            continue
        places = {k for row in rows[:i] for k, cell in enumerate(row.cells) if cell}
        below = (j for j in range(i, len(rows)) if _goes_on(rows[j], heading, places))
        after = next(below, len(rows))
        if after == len(rows):
            return i
        again = repeats(trim(rows[after].cells, width), heading)
        if again and (how := _of_another(rows, i, after, heading)):
            notes.append(
                f"another table begins in line {rows[after].number}, {how}; it is not read: "
                "save it in a file of its own where it is needed"
            )
            return i
        i = after + 1
    return len(rows)


def _is_gap(cells: Sequence[str]) -> bool:
    """Tell whether a line is blank, or holds text and fewer numbers than other cells."""
    filled = [cell for cell in cells if cell]
    return 2 * sum(map(is_numeral, filled)) < len(filled) or not filled


def _goes_on(row: FileLine, heading: Heading, places: Collection[int]) -> bool:
    """Tell whether a line is the header again, or a row of numbers in the columns of the table."""
    cells = trim(row.cells, len(heading.names))
    if len(cells) != len(heading.names):
        return False
    filled = {i: cell for i, cell in enumerate(cells) if cell}
    numbers = sum(map(is_numeral, filled.values()))
    is_row = numbers > 1 and 2 * numbers >= len(filled) and filled.keys() <= set(places)
    return is_row or repeats(cells, heading)


def _of_another(rows: Sequence[FileLine], gap: int, header: int, heading: Heading) -> str:
    """Say how the table below a header that stands again differs; nothing where it goes on.

    Parameters
    ----------
    rows
        All rows.
    gap, header
        Positions behind the last row above, and of the header.
    heading
        Names and units of the first table.
    """
    width = len(heading.names)
    below = [row for row in rows[header + 1 :] if any(row.cells)][:2]
    if below and holds_units(below[0]):
        again = [cell.strip(_BRACKETS) for cell in trim(below[0].cells, 1)]
        if len(again) < width:  # blanks do not show that a counter has no unit
            again = [*[""] * (width - len(again)), *again]
        if again != [(unit or "").strip(_BRACKETS) for unit in heading.units]:
            return f"in {', '.join(unit for unit in again if unit)}"
        below = below[1:]
    at = next((i for i, name in enumerate(heading.names) if _TIME.fullmatch(name)), 0)
    last = next((row for row in reversed(rows[:gap]) if len(row.cells) == width), None)
    if last is None or not below or len(below[0].cells) <= at:
        return ""
    old, new = _value(last.cells[at]), _value(below[0].cells[at])
    begins_anew = old is not None and new is not None and new < old
    return "with times that begin anew" if begins_anew else ""


def _value(cell: str) -> float | None:
    """Return the number of a cell, whichever its decimal sign; None where it holds none."""
    number = seconds_of_text(cell)
    if number is None:
        number = as_float(cell)
    return Numerals(",").number(cell) if number is None else number
