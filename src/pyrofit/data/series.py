"""Turn a table of a laboratory into a checked measured series in SI units."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.checks import check_finite, check_limits, check_order
from pyrofit.data.csvfile import FloatArray, Table, read_table
from pyrofit.data.download import sha256
from pyrofit.data.gaps import without_gaps
from pyrofit.errors import DataError, suggest
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import LIMITS, Quantity
from pyrofit.quantities.units import (
    CELSIUS,
    ICE_POINT_K,
    PER_AREA,
    PER_MASS,
    PER_START,
    SCALES,
    header_key,
    unit_key,
)

_FEWEST_POINTS = 3


@dataclass(frozen=True)
class SeriesSpec:
    """Where a measured series lies and how to read it.

    Parameters
    ----------
    quantity : str
        Name of a quantity, see `pyrofit.quantities`.
    path : Path
        The file.
    columns : mapping of str to str
        Header name by role (`time`, `value`, `uncertainty`, `temperature`); the others are
        recognised from well-known header names. The limits of a band, `lower` and `upper`, are
        read only where they are named.
    units : mapping of str to str
        Unit by role, in place of the one in the file.
    uncertainty : float, optional
        One uncertainty for all points, in the SI unit of the quantity; replaces the file's.
    uncertainty_meaning : str
        What the uncertainty is, such as "two standard deviations of the mean".
    sample_mass_kg : float, optional
        Initial mass of the sample [kg]: divides a mass to give a mass fraction, and a power to give
        one per mass.
    sample_area_m2 : float, optional
        Exposed area of the sample [m2]: divides a mass rate or a heat rate to give a flux, and a
        mass to give a mass per area.
    sign : int
        Sign of the file's values, 1 or -1.

    Raises
    ------
    DataError
        Unknown quantity or role, or a number that is not above 0.
    """

    quantity: str
    path: Path
    columns: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    uncertainty: float | None = None
    uncertainty_meaning: str = ""
    sample_mass_kg: float | None = None
    sample_area_m2: float | None = None
    sign: int = 1

    def __post_init__(self) -> None:
        if self.quantity not in (known := known_quantities()):
            raise DataError(
                f"{self.path}: unknown quantity '{self.quantity}'. {suggest(self.quantity, known)}"
            )
        for key in ("columns", "units"):
            for role in getattr(self, key):
                if role not in (roles := [*self.of.roles, *LIMITS]):
                    raise DataError(
                        f"{self.path}: `{key}` names an unknown role '{role}' for "
                        f"{self.quantity}. {suggest(role, roles)}"
                    )
        for key in ("uncertainty", "sample_mass_kg", "sample_area_m2"):
            number = getattr(self, key)
            if number is not None and not (math.isfinite(number) and number > 0.0):
                raise DataError(
                    f"{self.path}: {key} = {number}; it must be a number above 0. "
                    "Correct it or leave it out."
                )
        if len(given := [role for role in LIMITS if role in self.columns]) == 1:
            raise DataError(
                f"{self.path}: `columns` names the {given[0]} limit alone; name both, lower and "
                "upper, or neither."
            )
        if self.uncertainty is not None and "uncertainty" in self.columns:
            raise DataError(
                f"{self.path}: both a number and a column are given for the uncertainty; "
                "leave one of them out."
            )

    @property
    def of(self) -> Quantity:
        """The quantity."""
        return known_quantities()[self.quantity]


@dataclass(frozen=True, eq=False)
class Measurement:
    """A measured series in SI units.

    Parameters
    ----------
    quantity : Quantity
        What is measured.
    frame : DataFrame
        `time_s`, where the quantity has it `temperature_K`, the value (`quantity.column`) and, if
        known, its uncertainty (`quantity.uncertainty_column`) and the limits of a band
        (`quantity.limit_columns`).
    source : Path
        The file.
    sha256 : str
        Its SHA-256.
    uncertainty_meaning : str
        What the uncertainty is.
    notes : tuple of str
        What the reader left out, computed or noticed.
    """

    quantity: Quantity
    frame: pd.DataFrame
    source: Path
    sha256: str
    uncertainty_meaning: str
    notes: tuple[str, ...]


def read_series(spec: SeriesSpec) -> Measurement:
    """Read a measured series, convert it to SI units and check it.

    A mass `m` becomes the mass fraction `m / m_0`, with `m_0` the given mass of the sample, else
    the first value; a mass rate becomes the mass loss rate per area, `rate / area`, and a mass the
    mass per area where that is the quantity; a power becomes that per initial mass. Columns that
    are zero throughout are placeholders and are left out.

    Parameters
    ----------
    spec : SeriesSpec
        File, quantity, and what the file does not say itself.

    Returns
    -------
    Measurement
        The series, with notes on what was left out or computed.

    Raises
    ------
    DataError
        The file cannot be read as a table; a column is absent, ambiguous or all zero; a unit is
        absent or unknown; there are fewer than 3 points; time does not increase; an uncertainty
        is negative; or a value is so far off that its unit must be wrong.

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
    table = read_table(spec.path)
    _check_length(table)
    dummies = [name for name, column in table.columns.items() if not np.nan_to_num(column).any()]
    headers = _assign_columns(spec, table, dummies)
    table, gaps = without_gaps(table, headers)
    rows = _check_length(table)
    # What overflows here is found there.
    with np.errstate(over="ignore", invalid="ignore"):
        frame, notes = _convert_columns(spec, table, headers)
    check_finite(spec.path, frame)
    check_order(spec.of, table, headers, frame)
    check_limits(spec.of, table, headers, frame)
    notes += gaps
    if unread := [name for name in dummies if name not in headers.values()]:
        notes.append(f"left out, zero throughout: {', '.join(unread)}")
    if negative := int((frame[spec.of.column] < 0.0).sum()):
        notes.append(f"{negative} of {rows} values are negative")
    notes += _remarks(spec.of, frame)
    digest = sha256(spec.path)
    return Measurement(spec.of, frame, spec.path, digest, spec.uncertainty_meaning, tuple(notes))


def _check_length(table: Table) -> int:
    """Return the number of points, if these are enough."""
    rows = len(next(iter(table.columns.values())))
    if rows < _FEWEST_POINTS:
        raise DataError(
            f"{table.path}: given {rows} points; a series needs at least {_FEWEST_POINTS}. "
            "Give a longer file."
        )
    return rows


def _remarks(quantity: Quantity, frame: pd.DataFrame) -> list[str]:
    """Return what looks wrong with the values of a record against temperature."""
    if quantity.remark is None:
        return []
    columns = (frame[c].to_numpy(float) for c in ("temperature_K", quantity.column))
    said = quantity.remark(*columns)
    return [said] if said else []


def _assign_columns(spec: SeriesSpec, table: Table, dummies: Sequence[str]) -> dict[str, str]:
    """Find the header of each role: asked for by name, or recognised."""
    asked = {role: _find_asked(table, role, name) for role, name in spec.columns.items()}
    free = [name for name in table.columns if name not in asked.values()]
    headers: dict[str, str] = {}
    for role, known in spec.of.roles.items():
        usable = free if role == "time" else [name for name in free if name not in dummies]
        keys = {header_key(name) for name in known}
        matches = [asked[role]] if role in asked else [n for n in usable if header_key(n) in keys]
        if role == "uncertainty" and (spec.uncertainty is not None or set(matches) <= {*dummies}):
            continue
        if len(matches) != 1:
            problem = f"columns {matches} may all be" if matches else "no column is known to be"
            raise DataError(
                f"{table.path}: {problem} the {role} of {spec.quantity}; name the right one in "
                f"the study: `columns: {{{role}: ...}}`. {suggest(known[0], usable)}"
                + (f" Zero throughout: {', '.join(dummies)}." if dummies else "")
            )
        if matches[0] in dummies and role != "time":
            raise DataError(
                f"{table.path}, column '{matches[0]}': zero throughout, a placeholder; the {role} "
                "must be measured. Give another column or another file."
            )
        if matches[0] in headers.values():
            raise DataError(f"{table.path}: column '{matches[0]}' is given two roles; name two.")
        headers[role] = matches[0]
    # A limit may be zero throughout, and two roles may share one column.
    return headers | {role: asked[role] for role in LIMITS if role in asked}


def _find_asked(table: Table, role: str, asked: str) -> str:
    if asked in table.columns:
        return asked
    matches = [name for name in table.columns if header_key(name) == header_key(asked)]
    if len(matches) != 1:
        raise DataError(
            f"{table.path}: there is no column '{asked}' for the {role}. "
            f"{suggest(asked, table.columns)}"
        )
    return matches[0]


def _convert_columns(
    spec: SeriesSpec, table: Table, headers: Mapping[str, str]
) -> tuple[pd.DataFrame, list[str]]:
    for role in spec.units:
        if role not in headers:
            raise DataError(
                f"{table.path}: a unit is given for the {role}, but no column is read for it; "
                "leave the unit out or name the column."
            )
    data = {"time_s": _to_si(spec, table, headers, "time", ("time",))[0]}
    if "temperature" in headers:
        data["temperature_K"] = _to_si(spec, table, headers, "temperature", ("temperature",))[0]
    kinds = spec.of.scales
    value, kind = _to_si(spec, table, headers, "value", kinds)
    divisor, notes = _divisor(spec, kind, float(value[0]))
    data[spec.of.column] = spec.sign * value / divisor
    if spec.sign < 0:
        notes.append("the sign is changed")
    if spec.uncertainty is not None:
        data[spec.of.uncertainty_column] = np.full(len(value), spec.uncertainty)
        notes.append("one uncertainty is given for all points")
    elif "uncertainty" in headers:
        spread, its = _to_si(spec, table, headers, "uncertainty", (kind, kinds[0]))
        data[spec.of.uncertainty_column] = spread / divisor if its == kind else spread
    else:
        notes.append("no uncertainty is known")
    for role in (role for role in LIMITS if role in headers):
        limit, _ = _to_si(spec, table, headers, role, (kind,))
        data[spec.of.limit_columns[role]] = limit / divisor
    return pd.DataFrame(data), notes


def _to_si(
    spec: SeriesSpec, table: Table, headers: Mapping[str, str], role: str, kinds: Sequence[str]
) -> tuple[FloatArray, str]:
    """Convert one column to SI units; give also which of the kinds of quantity its unit is."""
    header = headers[role]
    unit = spec.units.get(role, table.units[header])
    scales = {unit_key(word): (kind, word) for kind in kinds for word in SCALES[kind]}
    known = [word for _, word in scales.values()]
    if not unit or (key := unit_key(unit)) not in scales:
        given = f"unknown unit '{unit}' of the {role}. " if unit else f"no unit of the {role}; "
        raise DataError(
            f"{table.path}, column '{header}': {given}{suggest(unit or '', known)} "
            f"Give it in the study: `units: {{{role}: ...}}`."
        )
    kind, word = scales[key]
    offset = ICE_POINT_K if word in CELSIUS and role != "uncertainty" else 0.0
    return table.columns[header] * SCALES[kind][word] + offset, kind


def _divisor(spec: SeriesSpec, kind: str, first: float) -> tuple[float, list[str]]:
    """Give the mass or the area by which a mass or a mass rate is divided."""
    wanted = spec.of.scales[0]
    if PER_AREA.get(kind) == wanted:
        if spec.sample_area_m2 is None:
            raise DataError(
                f"{spec.path}: the unit is that of a {kind}; give `sample_area_m2`, or the "
                f"right unit of a {wanted}, such as {spec.of.unit}."
            )
        return spec.sample_area_m2, [f"{kind} divided by {spec.sample_area_m2:g} m2"]
    if kind in PER_MASS:
        if spec.sample_mass_kg is None:
            raise DataError(
                f"{spec.path}: the unit is that of a {kind}; give `sample_mass_kg`, the initial "
                f"mass of the sample, or the right unit of a {PER_MASS[kind]}, such as W/g."
            )
        return spec.sample_mass_kg, [f"{kind} divided by {spec.sample_mass_kg:g} kg"]
    if PER_START.get(kind) != wanted:
        return 1.0, []
    mass = first if spec.sample_mass_kg is None else spec.sample_mass_kg
    if mass <= 0.0:
        raise DataError(
            f"{spec.path}: the first mass is {mass:g} kg; it must be above 0 to divide the others. "
            "Give `sample_mass_kg`."
        )
    which = "its first value" if spec.sample_mass_kg is None else "the mass of the sample"
    return mass, [f"mass divided by {which}, {mass:g} kg"]
