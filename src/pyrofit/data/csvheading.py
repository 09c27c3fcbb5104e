"""The heading of a table: names and units of its columns."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pyrofit.errors import DataError

_BRACKETED = re.compile(r"\[(.*)\]|\((.*)\)")
_NAME_AND_UNIT = re.compile(r"(.+?)\s*(?:\[(.*)\]|\((.*)\))")


@dataclass(frozen=True)
class Line:
    """A line of the file, from 1, and its cells."""

    number: int
    cells: list[str]


def name_columns(path: Path, heading: Sequence[Line]) -> tuple[list[str], list[str | None]]:
    """Tell names and units apart, whichever row comes first."""
    rows = list(heading)
    if len(rows) == 2 and all_bracketed(rows[0]) and not all_bracketed(rows[1]):
        rows.reverse()
    names = trim(rows[0].cells)
    units: list[str | None] = [None] * len(names)
    if len(rows) == 2:
        cells = trim(rows[1].cells)
        if len(cells) > len(names):
            raise ragged(path, rows[1].number, len(cells), len(names))
        units[: len(cells)] = [_strip_brackets(cell) for cell in cells]
    else:
        names, units = _split_units(names)
    _check_names(path, rows[0].number, names)
    return names, units


def is_number(cell: str) -> bool:
    """Tell whether a cell is written as a number."""
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell


def trim(cells: Sequence[str], width: int = 0) -> list[str]:
    """Drop the empty cells that trailing delimiters leave, down to a width."""
    end = len(cells)
    while end > width and not cells[end - 1]:
        end -= 1
    return list(cells[:end])


def all_bracketed(line: Line) -> bool:
    """Tell whether a line holds nothing but units in brackets."""
    return all(_BRACKETED.fullmatch(cell) for cell in line.cells if cell)


def _strip_brackets(cell: str) -> str | None:
    match = _BRACKETED.fullmatch(cell)
    inner = (match[1] or match[2] or "") if match else cell
    return inner.strip() or None


def _split_units(headers: Sequence[str]) -> tuple[list[str], list[str | None]]:
    names: list[str] = []
    units: list[str | None] = []
    for header in headers:
        match = _NAME_AND_UNIT.fullmatch(header)
        names.append(match[1] if match else header)
        units.append((match[2] or match[3] or "").strip() or None if match else None)
    return names, units


def _check_names(path: Path, line: int, names: Sequence[str]) -> None:
    for i, name in enumerate(names):
        if not name:
            raise DataError(
                f"{path}, line {line}: column {i + 1} has no name; name it or delete it."
            )
        if name in names[:i]:
            raise DataError(
                f"{path}, line {line}: columns {names.index(name) + 1} and {i + 1} are both named "
                f"'{name}'; each column needs its own name. Rename or delete one."
            )


def ragged(path: Path, line: int, given: int, width: int) -> DataError:
    """Return the error of a row with more or fewer cells than the header has names."""
    return DataError(
        f"{path}, line {line}: given {given} cells; the header names {width} columns, and each row "
        "needs as many. Complete the row or delete it; for decimal commas, write points."
    )
