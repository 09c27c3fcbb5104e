"""Files that cone calorimeters write: turned into a header and rows before they are read."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from pyrofit.data.csvheading import is_number, trim
from pyrofit.data.line import FileLine
from pyrofit.data.numerals import ABSENT, Numerals, is_numeral, numerals_of
from pyrofit.data.oxygen import FloatArray, heat_release_rate
from pyrofit.errors import DataError
from pyrofit.quantities.units import ICE_POINT_K

_AREA, _C_FACTOR = "surface area (cm2)", "c-factor (si units)"
_FTT_KEYS = {"laboratory name", _C_FACTOR, _AREA, "date of test"}
_DEATAK = "names"
_FEWEST_KEYS = 2
_BEFORE = 10
"""Rows from which the oxygen of the air is taken where nothing tells the start of the test."""


def is_export(lines: Sequence[Sequence[str]]) -> bool:
    """Tell whether cells are those of an export of a cone calorimeter.

    >>> is_export([["Laboratory name", "X", "Time (s)"], ["Surface area (cm²)", "88", "0"]])
    True
    """
    filled = [cells for cells in lines if any(cells)]
    first = [cell.casefold() for cell in filled[0]]
    keys = {_key(cells[0]) for cells in filled}
    ftt = len(keys & _FTT_KEYS) >= _FEWEST_KEYS and "time (s)" in first[2:]
    return ftt or first[:2] == [_DEATAK, "time"]


def unfolded(
    path: Path, lines: Sequence[FileLine], notes: list[str]
) -> tuple[list[FileLine], float | None]:
    """Return a cone calorimeter's export as a header and rows, and the exposed area [m2].

    The first two columns of FTT's files hold keys and values. The scans of Deatak have names in the
    first row and units below. Their keys are in a file beside them, named `Scalar` instead of
    `Scan`. Where a file has no heat release rate, it is computed from the oxygen, see
    `pyrofit.data.oxygen`.

    Raises
    ------
    DataError
        No row holds a number.
    """
    if lines[0].cells[0].casefold() == _DEATAK:
        return _deatak(path, lines, notes)
    return _ftt(path, lines, notes)


def _ftt(
    path: Path, lines: Sequence[FileLine], notes: list[str]
) -> tuple[list[FileLine], float | None]:
    known = {_key(line.cells[0]): line.cells[1] for line in lines if len(line.cells) > 1}
    names = trim(lines[0].cells[2:])
    rows = [FileLine(line.number, line.cells[2 : 2 + len(names)]) for line in lines[1:]]
    rows = [row for row in rows if any(map(_counts, row.cells))]
    numerals = _numerals(path, rows)
    notes.append(f"FTT export with {len(known)} keys")
    places = {name.casefold(): i for i, name in enumerate(names)}
    start = _number(known.get("test start time (s)"), numerals)
    if start:
        notes.append(f"the test starts at {start:g} s of the record: give `delay_s: {start:g}`")
    wanted = ("time (s)", "o2 (%)", "dpt (pa)", "stack tc (k)")
    columns = _columns(rows, places, wanted, (0.0, 0.0, 0.0, 0.0), numerals)
    square_cm = _number(known.get(_AREA), numerals)
    area = square_cm * 1e-4 if square_cm else None
    if area:
        notes.append(f"exposed area {area:g} m2: give it as `sample_area_m2` where needed")
    facts = {
        "Surface area (cm²)": area,
        "C-factor (SI units)": _number(known.get(_C_FACTOR), numerals),
    }
    delay = _number(known.get("o2 delay time (s)"), numerals)
    header = FileLine(lines[0].number, names)
    return _with_heat_release([header, *rows], columns, facts, delay, start, numerals, notes), area


def _deatak(
    path: Path, lines: Sequence[FileLine], notes: list[str]
) -> tuple[list[FileLine], float | None]:
    by_key = {line.cells[0].casefold(): line.cells[1:] for line in lines[:8]}
    names, units = by_key[_DEATAK], by_key.get("units", [])
    units = [*units, *[""] * (len(names) - len(units))]
    words = {"sec": "s", "C": "degC"}
    header = [
        f"{n} ({words.get(u, u)})" if u else n for n, u in zip(names, units, strict=False) if n
    ]
    rows = [FileLine(row.number, row.cells[1:]) for row in lines if is_number(row.cells[0])]
    numerals = _numerals(path, rows)
    notes.append("Deatak scan")
    places = {name.casefold(): i for i, name in enumerate(names)}
    wanted = ("time", "o2 meter", "exh press", "stack tc")
    columns = _columns(rows, places, wanted, (0.0, 0.0, 0.0, ICE_POINT_K), numerals)
    scalars = _scalars(path)
    numbers = {key: _number(cell, numerals) for key, cell in scalars.items()}
    facts = {key: numbers.get(key.casefold()) for key in ("SURF AREA", "C FACTOR")}
    delay, area = numbers.get("o2 delay time"), facts["SURF AREA"] or None
    table = [FileLine(lines[0].number, header), *rows]
    return _with_heat_release(table, columns, facts, delay, None, numerals, notes), area


def _scalars(path: Path) -> dict[str, str]:
    """Return the keys of the file beside a scan; none where there is no such file."""
    beside = path.with_name(path.name.replace("Scan", "Scalar"))
    if beside == path or not beside.is_file():
        return {}
    text = beside.read_bytes().decode("cp1252", errors="replace")
    pairs = (line.split(",", 1) for line in text.splitlines() if "," in line)
    return {key.strip().casefold(): value.strip() for key, value in pairs}


def _columns(
    rows: Sequence[FileLine],
    places: Mapping[str, int],
    names: Sequence[str],
    offsets: Sequence[float],
    numerals: Numerals,
) -> list[FloatArray] | None:
    """Return time, oxygen [%], pressure [Pa] and temperature [K]; None where one is missing."""
    if any(name not in places for name in names):
        return None
    columns = []
    for name, offset in zip(names, offsets, strict=True):
        i = places[name]
        cells = [row.cells[i] if i < len(row.cells) else "" for row in rows]
        numbers = [numerals.number(cell) for cell in cells]
        columns.append(np.array([np.nan if x is None else x for x in numbers]) + offset)
    return columns


def _with_heat_release(
    lines: list[FileLine],
    columns: list[FloatArray] | None,
    facts: Mapping[str, float | None],
    delay: float | None,
    start: float | None,
    numerals: Numerals,
    notes: list[str],
) -> list[FileLine]:
    """Add the heat release rate per area, where the file has none and tells all that it needs.

    Parameters
    ----------
    lines
        Header and rows.
    columns
        Time, oxygen, pressure and temperature; None where one is missing.
    facts
        Exposed area [m2] and C factor, by the file's words for them.
    delay, start
        Delay of the oxygen, and start of the test [s].
    numerals
        How the file writes numbers.
    notes
        Notes on the file, to which those on the heat release rate are added.
    """
    area, c_factor = facts.values()
    if any("hrr" in name.casefold() for name in lines[0].cells):
        return lines
    if columns is None or not area or not c_factor:
        missing = [key for key, number in facts.items() if not number]
        missing += [] if columns else ["a column of oxygen, pressure or temperature of the duct"]
        notes.append(f"no HRR is computed from the oxygen: {' and '.join(missing)} not given")
        return lines
    time, percent, pressure, stack = columns
    before = time < start if start else np.arange(time.size) < _BEFORE
    before = before if before.any() else np.arange(time.size) < _BEFORE
    ambient = float(np.nanmean(percent[before])) / 100.0
    q = heat_release_rate(time, percent / 100.0, pressure, stack, c_factor, ambient, delay or 0.0)
    notes.append(
        f"HRR computed from oxygen: C = {c_factor:g}, {100 * ambient:.4g} % before the test, "
        f"delay {delay or 0.0:g} s, {area:g} m2"
    )
    width = len(lines[0].cells)
    header = FileLine(lines[0].number, [*lines[0].cells, "HRR (kW/m2)"])
    rows = [
        FileLine(
            row.number,
            [*_filled(row.cells, width), f"{x / area / 1e3:.6g}".replace(".", numerals.decimal)],
        )
        for row, x in zip(lines[1:], q, strict=True)
    ]
    return [header, *rows]


def _filled(cells: Sequence[str], width: int) -> list[str]:
    return [*cells[:width], *[""] * (width - len(cells))]


def _numerals(path: Path, rows: Sequence[FileLine]) -> Numerals:
    """Return how the rows write numbers."""
    if not rows:
        raise DataError(
            f"{path}: this export of a cone calorimeter holds a header and no numbers; the record "
            "must follow below the names of its columns. Export it again with its rows."
        )
    return numerals_of(rows)


def _counts(cell: str) -> bool:
    """Tell whether a cell makes its line a row: a number in any form, or `NaN`."""
    return is_number(cell) or (is_numeral(cell) and cell.casefold() not in ABSENT)


def _key(cell: str) -> str:
    """Return a key in one spelling: `Surface area (cm²)` and `(cm2)` are the same."""
    return cell.casefold().replace("²", "2").replace("^", "")


def _number(cell: str | None, numerals: Numerals) -> float | None:
    """Return the number of a key, in the form of the rows, else in its own."""
    if cell is None:
        return None
    number = numerals.number(cell)
    return numerals_of([FileLine(0, [cell])]).number(cell) if number is None else number
