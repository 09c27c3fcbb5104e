"""Columns of a measured file in SI units."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from pyrofit.data.checks import WHOLE, is_change
from pyrofit.data.csvfile import FileTable, FloatArray
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError, suggest
from pyrofit.quantities.base import LIMITS, Quantity
from pyrofit.quantities.units import PER_AREA, PER_MASS, PER_START, SCALES, ZEROS_K, unit_key

TARED = 0.05
"""Share of the range of masses within which the first one of a tared balance lies about zero."""
OTHER_ZERO = 0.2
"""Share of the stated initial mass by which the first mass differs where its zero is arbitrary."""


def convert_columns(
    spec: SeriesSpec, table: FileTable, headers: Mapping[str, str]
) -> tuple[pd.DataFrame, list[str]]:
    """Return the columns of a series in SI units, and notes on the conversion.

    Raises
    ------
    DataError
        A unit is absent or unknown, or a mass or area to divide by is missing.
    """
    for role in spec.units:
        if role not in headers:
            raise DataError(
                f"{table.path}: a unit is given for the {role}, but no column is read for it; "
                "leave the unit out or name the column."
            )
    data = {}
    if "time" in headers:
        data["time_s"] = to_si(spec, table, headers, "time", ("time",))[0]
    if "temperature" in headers:
        temperature = to_si(spec, table, headers, "temperature", ("temperature",))[0]
        if spec.rate_K_s is not None:
            data["time_s"] = (temperature - temperature[0]) / spec.rate_K_s
        data["temperature_K"] = temperature
    elif spec.rate_K_s is not None and spec.start_K is not None:
        data["temperature_K"] = spec.start_K + spec.rate_K_s * data["time_s"]
    kinds = spec.of.scales
    value, kind = to_si(spec, table, headers, "value", kinds)
    value, of_zero = _from_start(spec, table, kind, value)
    divisor, notes = _divisor(spec, kind, float(value[0]))
    notes += of_zero
    notes += _overridden(spec, table, headers)
    data[spec.of.column] = spec.sign * value / divisor
    if spec.sign < 0:
        notes.append("the sign is changed")
    if spec.uncertainty is not None:
        data[spec.of.uncertainty_column] = np.full(len(value), spec.uncertainty)
        notes.append("one uncertainty is given for all points")
    elif "uncertainty" in headers:
        spread, its = to_si(spec, table, headers, "uncertainty", (kind, kinds[0]))
        data[spec.of.uncertainty_column] = spread / divisor if its == kind else spread
    else:
        notes.append("no uncertainty is known")
    for role in (role for role in LIMITS if role in headers):
        limit, _ = to_si(spec, table, headers, role, (kind,))
        data[spec.of.limit_columns[role]] = limit / divisor
    return pd.DataFrame(data), notes


def _from_start(
    spec: SeriesSpec, table: FileTable, kind: str, value: FloatArray
) -> tuple[FloatArray, list[str]]:
    """Return masses of a tared balance, whose zero is arbitrary, from the stated initial mass on.

    Raises
    ------
    DataError
        The first mass is not the initial mass that the file states, and the study gives none.
    """
    if is_change_of_fraction(spec.of, kind, value):
        return value + 1.0, ["a change of mass: 100 % is added"]
    if kind != "mass" or PER_START[kind] != spec.of.scales[0]:
        return value, []
    stated = stated_mass(table, value)
    first, given = float(value[0]), spec.sample_mass_kg
    if stated is None:
        if given is None or not has_other_zero(value, given):
            return value, []
        return value - first + given, [
            f"the zero of the balance is arbitrary: {given:g} kg at first"
        ]
    if abs(first - stated) <= OTHER_ZERO * stated:
        return value, []
    if given is None:
        raise DataError(
            f"{spec.path}: the first mass is {first:g} kg, the file states an initial mass of "
            f"{stated:g} kg. If the zero of the balance is arbitrary, give `sample_mass_kg: "
            f"{stated:g}`; if the file is wrong there, correct its mass."
        )
    if abs(given - stated) > OTHER_ZERO * stated:
        return value, []
    note = f"the zero of the balance is arbitrary: {stated:g} kg, as the file states, at first"
    return value - first + stated, [note]


def is_change_of_fraction(quantity: Quantity, kind: str, value: FloatArray) -> bool:
    """Tell whether fractions are changes of the mass, by no more than the whole of it."""
    fractions = kind == "fraction" and "mass" in quantity.scales
    return fractions and is_change(value) and float(value.min()) >= -WHOLE


def stated_mass(table: FileTable, mass: FloatArray) -> float | None:
    """Return the initial mass [kg] that a file states of a sample with these masses; else None.

    One that no key names may be nominal: it counts where the balance has another zero.
    """
    stated = table.stated.mass_kg
    if stated is None or table.stated.mass_named or has_other_zero(mass, stated):
        return stated
    return None


def has_other_zero(mass: FloatArray, initial: float) -> bool:
    """Tell whether masses begin at zero or far above the initial mass, and lose no more than it."""
    first, lowest, largest = float(mass[0]), float(np.nanmin(mass)), float(np.nanmax(mass))
    tared = abs(first) < TARED * (largest - lowest)
    other = tared or first > (1.0 + OTHER_ZERO) * initial
    return other and first - lowest < (1.0 + OTHER_ZERO) * initial


def _overridden(spec: SeriesSpec, table: FileTable, headers: Mapping[str, str]) -> list[str]:
    """Note units of the study that convert a column otherwise than the file's own would."""
    notes = []
    for role, unit in spec.units.items():
        stated = table.units[headers[role]]
        kinds = spec.of.scales if role not in ("time", "temperature") else (role,)
        of_file, of_study = _meaning(stated or "", kinds), _meaning(unit, kinds)
        if of_file and of_study and of_file != of_study:
            notes.append(f"the {role} is read in {unit}, as the study says; the file says {stated}")
    return notes


def _meaning(unit: str, kinds: Sequence[str]) -> tuple[str, float, float] | None:
    """Return kind, factor and zero of a unit; None where it is unknown."""
    for kind in kinds:
        for word, factor in SCALES[kind].items():
            if unit_key(word) == unit_key(unit):
                return kind, factor, ZEROS_K.get(word, 0.0)
    return None


def to_si(
    spec: SeriesSpec, table: FileTable, headers: Mapping[str, str], role: str, kinds: Sequence[str]
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
            + (
                "Convert the column, or correct the unit in the study"
                if unit
                else "Give it in the study"
            )
            + f": `units: {{{role}: ...}}`."
        )
    kind, word = scales[key]
    offset = 0.0 if role == "uncertainty" else ZEROS_K.get(word, 0.0)
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
                f"{spec.path}: the unit is that of a {kind}. Give `sample_mass_kg`, the initial "
                f"mass of the sample, or the right unit of a {PER_MASS[kind]}, such as W/g."
            )
        return spec.sample_mass_kg, [f"{kind} divided by {spec.sample_mass_kg:g} kg"]
    if spec.from_first and kind == "fraction":
        if first <= 0.0:
            raise DataError(f"{spec.path}: the first value is {first:g}; leave `relative_to` out")
        return first, [f"mass fraction divided by its first value, {first:g}"]
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
