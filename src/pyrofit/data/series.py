"""Turn a table of a laboratory into a checked measured series in SI units."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.checks import check_finite, check_limits, check_order, check_zero
from pyrofit.data.convert import convert_columns
from pyrofit.data.csvfile import FileTable, read_table
from pyrofit.data.download import sha256
from pyrofit.data.gaps import without_doubles, without_gaps, without_stops, without_times_before
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError, suggest
from pyrofit.quantities.base import LIMITS, Quantity
from pyrofit.quantities.units import SCALES, header_key, unit_key

_FEWEST_POINTS = 3
MOST_POINTS = 20_000
"""Points of a series; every n-th row of a longer one is used."""


@dataclass(frozen=True, eq=False)
class Measurement:
    """A measured series in SI units.

    Parameters
    ----------
    quantity : Quantity
        The measured quantity.
    frame : DataFrame
        `time_s`, where the quantity has it `temperature_K`, the value (`quantity.column`) and, if
        known, its uncertainty (`quantity.uncertainty_column`) and the limits of a band
        (`quantity.limit_columns`).
    source : Path
        The file.
    sha256 : str
        Its SHA-256.
    uncertainty_meaning : str
        The meaning of the uncertainty.
    notes : tuple of str
        The reader's notes: omissions, computations and remarks.
    in_K : bool
        Whether its temperatures are in K in the file.
    """

    quantity: Quantity
    frame: pd.DataFrame
    source: Path
    sha256: str
    uncertainty_meaning: str
    notes: tuple[str, ...]
    in_K: bool = False


def read_series(spec: SeriesSpec, read: Callable[[Path], FileTable] = read_table) -> Measurement:
    """Read a measured series, convert it to SI units and check it.

    A mass `m` becomes the mass fraction `m / m_0`, with `m_0` the given mass of the sample, else
    the first value. Where the quantity is one per area, a mass becomes the mass per area. A mass
    rate becomes the mass loss rate per area, `rate / area`, and a power that per initial mass.
    Columns that are zero throughout are placeholders and are left out. Of more than `MOST_POINTS`
    rows every n-th is used.

    Parameters
    ----------
    spec : SeriesSpec
        File, quantity, and the facts that the file does not state itself.
    read : callable
        Reader of the file, where it is read once for several series.

    Returns
    -------
    Measurement
        The series, with notes on omissions and computations.

    Raises
    ------
    DataError
        The file cannot be read as a table. A column is absent, ambiguous or all zero, or a unit is
        absent or unknown. There are fewer than 3 points, time does not increase, or an uncertainty
        is negative. A value is so far off that its unit must be wrong.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "tga.csv"
    ...     text = "Time (min),Temperature (degC),Mass (mg)"
    ...     _ = path.write_text(text + chr(10) + chr(10).join(["0,40,5", "1,50,5", "2,60,4"]))
    ...     print(read_series(SeriesSpec("mass_fraction", path)).frame.to_string(index=False))
     time_s  temperature_K  mass_fraction
        0.0         313.15            1.0
       60.0         323.15            1.0
      120.0         333.15            0.8
    """
    table = read(spec.path)
    _check_length(table)
    dummies = [
        name
        for name, column in table.columns.items()
        if name not in table.faults and not np.nan_to_num(column).any()
    ]
    headers = _assign_columns(spec, table, dummies)
    table.require([*headers.values()])
    table, gaps = without_gaps(table, headers)
    if "time" in headers:
        table, doubles = without_doubles(table, headers["time"])
        table, early = without_times_before(table, headers["time"])
        gaps += [*doubles, *early]
    if spec.computed == "time":
        table, stops = without_stops(table, headers["temperature"])
        gaps += stops
    rows = _check_length(table)
    unit = spec.units.get("value", table.units[headers["value"]])
    known = table.stated.mass_kg is not None or (
        spec.sample_mass_kg is not None and spec.of.scales[0] == "fraction"
    )
    if not known or unit_key(unit or "") not in map(unit_key, SCALES["mass"]):
        check_zero(spec.of, table, headers, unit, spec.sign)
    # An overflow here is found by `check_finite`.
    with np.errstate(over="ignore", invalid="ignore"):
        frame, notes = convert_columns(spec, table, headers)
    check_finite(spec.path, frame)
    check_order(spec.of, table, headers, frame)
    check_limits(spec.of, table, headers, frame)
    notes = [*table.mended, *notes, *gaps]
    if unread := [name for name in dummies if name not in headers.values()]:
        notes += [f"left out, {words}" for words in _absent(table, unread)]
    if negative := int((frame[spec.of.column] < 0.0).sum()):
        notes.append(f"{negative} of {rows} values are negative")
    notes += _remarks(spec.of, frame)
    frame, thinned = _thinned(frame)
    notes += thinned
    digest = sha256(spec.path)
    role = "temperature" if spec.of.against_temperature else "value"
    given = spec.units.get(role) or (table.units[headers[role]] if role in headers else None)
    in_K = unit_key(given or "") == "k"
    meaning = spec.uncertainty_meaning
    return Measurement(spec.of, frame, spec.path, digest, meaning, tuple(notes), in_K)


def _absent(table: FileTable, names: Sequence[str]) -> list[str]:
    """Say which of some columns are zero throughout, and which hold no values."""
    empty = [name for name in names if np.isnan(table.columns[name]).all()]
    zero = [name for name in names if name not in empty]
    given = {"zero throughout": zero, "without values": empty}
    return [f"{why}: {', '.join(those)}" for why, those in given.items() if those]


def _check_length(table: FileTable) -> int:
    """Return the number of points, if these are enough."""
    rows = len(next(iter(table.columns.values())))
    if rows < _FEWEST_POINTS:
        raise DataError(
            f"{table.path}: given {rows} points; a series needs at least {_FEWEST_POINTS}. "
            "Give a longer file."
        )
    return rows


def _remarks(quantity: Quantity, frame: pd.DataFrame) -> list[str]:
    """Return remarks on suspect values of a record against temperature."""
    if quantity.remark is None:
        return []
    columns = (frame[c].to_numpy(float) for c in ("temperature_K", quantity.column))
    said = quantity.remark(*columns)
    return [said] if said else []


def _thinned(frame: pd.DataFrame) -> tuple[pd.DataFrame, list[str]]:
    """Return every n-th row of a series with too many points, the first and last included."""
    rows = len(frame)
    if rows <= MOST_POINTS:
        return frame, []
    kept = np.unique(np.linspace(0, rows - 1, MOST_POINTS).round().astype(int))
    thin = frame.iloc[kept].reset_index(drop=True)
    return thin, [f"thinned: {len(thin):,} of {rows:,} rows are used, evenly spread"]


def _assign_columns(spec: SeriesSpec, table: FileTable, dummies: Sequence[str]) -> dict[str, str]:
    """Find the header of each role: asked for by name, or recognised."""
    asked = {role: _find_asked(table, role, name) for role, name in spec.columns.items()}
    free = [name for name in table.columns if name not in asked.values()]
    headers: dict[str, str] = {}
    for role, known in spec.of.roles.items():
        if role == spec.computed:
            continue
        usable = free if role == "time" else [name for name in free if name not in dummies]
        keys = {header_key(name) for name in known}
        matches = [asked[role]] if role in asked else [n for n in usable if header_key(n) in keys]
        if role == "uncertainty" and (spec.uncertainty is not None or set(matches) <= {*dummies}):
            continue
        if len(matches) != 1:
            problem = f"columns {matches} may all be" if matches else "no column is known to be"
            raise DataError(
                f"{table.path}: {problem} the {role} of {spec.quantity}; name the right one in "
                f"the study: `columns: {{{role}: ...}}`. "
                + (suggest(known[0], usable) if usable else "The file has no further column.")
                + "".join(f" {words[0].upper()}{words[1:]}." for words in _absent(table, dummies))
            )
        if matches[0] in dummies and role != "time":
            empty = np.isnan(table.columns[matches[0]]).all()
            what = "it holds no values" if empty else "zero throughout, a placeholder"
            raise DataError(
                f"{table.path}, column '{matches[0]}': {what}; the {role} "
                "must be measured. Give another column or another file."
            )
        if matches[0] in headers.values():
            raise DataError(f"{table.path}: column '{matches[0]}' is given two roles; name two.")
        headers[role] = matches[0]
    # A limit may be zero throughout, and two roles may share one column.
    return headers | {role: asked[role] for role in LIMITS if role in asked}


def _find_asked(table: FileTable, role: str, asked: str) -> str:
    if asked in table.columns:
        return asked
    matches = [name for name in table.columns if header_key(name) == header_key(asked)]
    if len(matches) != 1:
        raise DataError(
            f"{table.path}: there is no column '{asked}' for the {role}. "
            f"{suggest(asked, table.columns)}"
        )
    return matches[0]
