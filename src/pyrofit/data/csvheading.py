"""The heading of a table: names and units of its columns."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pyrofit.data.line import FileLine
from pyrofit.data.numerals import as_float
from pyrofit.errors import DataError
from pyrofit.quantities.units import SCALES, unit_key

_BRACKETED = re.compile(r"\[(.*)\]|\((.*)\)")
_NAME_AND_UNIT = re.compile(r"(.+?)\s*(?:\[(.*)\]|\((.*)\))")
_NAME_SLASH_UNIT = re.compile(r"([^/(\[]+(?:\([^()/]*\))?)/(.+)")
_KNOWN = {unit_key(word) for scale in SCALES.values() for word in scale}


@dataclass(frozen=True)
class Heading:
    """Name of each column, each its own; its unit; its name in the file, or nothing."""

    names: list[str]
    units: list[str | None]
    given: list[str]


def named_columns(path: Path, heading: Sequence[FileLine], notes: list[str]) -> Heading:
    """Tell names and units apart, whichever row comes first."""
    rows = list(heading)
    if len(rows) == 2 and units_come_first(rows[0], rows[1]):
        rows.reverse()
    names = [cell.lstrip("#").strip() for cell in trim(rows[0].cells)]
    units: list[str | None] = [None] * len(names)
    if len(rows) == 2:
        cells = trim(rows[1].cells)
        if len(cells) > len(names):
            raise ragged(path, rows[1].number, len(cells), len(names))
        units[: len(cells)] = [_strip_brackets(cell) for cell in cells]
    else:
        names, units = _split_units(names)
    return Heading(_own_names(names, units, notes), units, names)


def is_number(cell: str) -> bool:
    """Tell whether a cell is written as a number with a decimal point, or is not a number."""
    return as_float(cell) is not None or cell.strip("+-").casefold() == "nan"


def trim(cells: Sequence[str], width: int = 0) -> list[str]:
    """Drop the empty cells that trailing delimiters leave, down to a width."""
    end = len(cells)
    while end > width and not cells[end - 1]:
        end -= 1
    return list(cells[:end])


def all_bracketed(line: FileLine) -> bool:
    """Tell whether a line holds nothing but units in brackets."""
    return all(_BRACKETED.fullmatch(cell) for cell in line.cells if cell)


def units_come_first(first: FileLine, second: FileLine) -> bool:
    """Tell whether units stand above names: in brackets, or as in tables of FDS.

    >>> units_come_first(FileLine(1, ["s", "C", "1/s"]), FileLine(2, ["Time", "Temp", "MLR"]))
    True
    """
    if all_bracketed(first):
        return not all_bracketed(second)
    times = {unit_key(word) for word in SCALES["time"]}
    return unit_key(first.cells[0]) in times and holds_units(first) and not holds_units(second)


def holds_units(line: FileLine) -> bool:
    """Tell whether at least half of a line's cells are units, and no names."""
    filled = [cell for cell in line.cells if cell]
    units = [c for c in filled if _BRACKETED.fullmatch(c) or unit_key(c) in _KNOWN]
    return bool(filled) and 2 * len(units) >= len(filled)


def holds_names_with_units(line: FileLine) -> bool:
    """Tell whether at least half of a line's cells are names with their units."""
    filled = [cell for cell in line.cells if cell]
    both = [unit for cell, unit in zip(filled, _split_units(filled)[1], strict=True) if unit]
    return bool(filled) and 2 * len(both) >= len(filled) and not all_bracketed(line)


def _strip_brackets(cell: str) -> str | None:
    match = _BRACKETED.fullmatch(cell)
    inner = (match[1] or match[2] or "") if match else cell
    return inner.strip() or None


def _split_units(headers: Sequence[str]) -> tuple[list[str], list[str | None]]:
    names: list[str] = []
    units: list[str | None] = []
    for header in headers:
        slash = _NAME_SLASH_UNIT.fullmatch(header)
        if slash and (unit := _unit_behind_slash(slash[1], slash[2])):
            names.append(slash[1].strip())
            units.append(unit)
            continue
        name, inner = _last_bracket(header)
        names.append(name)
        units.append(inner or None)
    return names, units


def _last_bracket(header: str) -> tuple[str, str]:
    """Return a name, and the text of the bracket at its end; nothing where there is none.

    >>> _last_bracket("MLR (kg/(m2 s))"), _last_bracket("Heat Flow (Normalized) (W/g)")
    (('MLR', 'kg/(m2 s)'), ('Heat Flow (Normalized)', 'W/g'))
    """
    depth = 0
    for i in range(len(header) - 1, 0, -1):
        depth += (header[i] in ")]") - (header[i] in "([")
        if depth <= 0:
            break
    inner = _BRACKETED.fullmatch(header[i:]) if len(header) > 1 and depth == 0 else None
    if inner is None or header[:i].count("(") > header[:i].count(")"):
        match = _NAME_AND_UNIT.fullmatch(header)
        return (match[1], (match[2] or match[3] or "").strip()) if match else (header, "")
    return header[:i].rstrip(" /"), (inner[1] or inner[2] or "").strip()


def _unit_behind_slash(name: str, text: str) -> str | None:
    """Return the unit of a header such as `Mass/%` or `DSC/(mW/mg)`; None for `MLR g/s`."""
    words = re.split(r"[ _]", name)
    if len(words) > 1 and unit_key(words[-1]) in _KNOWN:
        return None
    if _BRACKETED.fullmatch(text) or unit_key(text) in _KNOWN:
        return _strip_brackets(text)
    return None


def _own_names(names: list[str], units: Sequence[str | None], notes: list[str]) -> list[str]:
    """Give each column its own name: columns of one name get their unit or a number behind it."""
    own = [name or f"column {i}" for i, name in enumerate(names, start=1)]
    for name in dict.fromkeys(own):
        places = [i for i, other in enumerate(own) if other == name]
        if len(places) < 2:
            continue
        of = [units[i] for i in places]
        told = None not in of and len(set(of)) == len(of)
        for count, i in enumerate(places, start=1):
            own[i] = f"{name} ({units[i] if told else count})"
        notes.append(f"columns of one name are told apart as {', '.join(own[i] for i in places)}")
    return own


def ragged(path: Path, line: int, given: int, width: int) -> DataError:
    """Return the error of a row with more or fewer cells than the header has names."""
    return DataError(
        f"{path}, line {line}: given {given} cells; the header names {width} columns, and each row "
        "needs as many. Complete the row or delete it; for decimal commas, write points."
    )
