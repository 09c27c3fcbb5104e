"""In which unit the columns of a measured file are: stated, or guessed from the numbers."""

import re
from collections.abc import Mapping

import numpy as np

from pyrofit.data.csvfile import FileTable, FloatArray
from pyrofit.data.suspect import STANDARD_RATES
from pyrofit.numerics import functions
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import SCALES, header_key, unit_key

_SPELLINGS = {
    "sec": "s",
    "secs": "s",
    "seconds": "s",
    "mins": "min",
    "minutes": "min",
    "hours": "h",
    "kelvin": "K",
    "celsius": "degC",
    "deg_c": "degC",
    "°c": "degC",
    "c": "degC",
    "f": "degF",
    "deg_f": "degF",
    "k": "K",
    "percent": "%",
    "pct": "%",
    "wt%": "%",
    "wt.%": "%",
    "milligrams": "mg",
    "milligram": "mg",
    "grams": "g",
    "gram": "g",
    "micrograms": "ug",
    "hour": "h",
    "мин": "min",
    "с": "s",
    "мг": "mg",
    "gm2s": "g/m2/s",
    "kgm2s": "kg/m2/s",
}
"""Spellings of units that the reader does not know."""
_KNOWN = {unit_key(word) for scale in SCALES.values() for word in scale}
_CUT = re.compile(r"[ _](?=[^\W\d_]|[%°µ])")
_PER_AREA = re.compile(r"([A-Za-zµ]+/)?(ft|in|[cm]?m)\^?-?2(/(s|sec|min|h)(-1)?)?", re.IGNORECASE)
"""A unit per area, known or not."""
_INTERVALS, _HELD = 50, 0.05
"""Parts of a record with a slope each; below that share of the largest slope it is held."""


def kinds_of_units(quantity: Quantity, role: str) -> tuple[str, ...]:
    """Return the kinds of unit that a role of a quantity may have, see `SCALES`."""
    return quantity.scales if role in ("value", "uncertainty") else (role,)


def kind_of_unit(unit: str, kinds: tuple[str, ...]) -> str:
    """Return of which kind a unit is; nothing where it is of none."""
    key = unit_key(unit)
    return next((k for k in kinds if key in {unit_key(word) for word in SCALES[k]}), "")


def split_unit(header: str) -> tuple[str, str]:
    """Cut the unit from the end of a header, as in `time_min`; nothing where there is none.

    >>> split_unit("mlr_mg_cm2_s"), split_unit("T_degC"), split_unit("Temperature 1")
    (('mlr', 'mg/cm2/s'), ('T', 'degC'), ('Temperature 1', ''))
    >>> split_unit("Zeit in min"), split_unit("Zeit, min")
    (('Zeit', 'min'), ('Zeit', 'min'))
    """
    for cut in _CUT.finditer(header):
        end = header[cut.end() :]
        for unit in (end, re.sub(r"[_ ]", "/", end)):
            spelled = _SPELLINGS.get(unit.casefold(), unit)
            if unit_key(spelled) in _KNOWN or _PER_AREA.fullmatch(unit):
                return header[: cut.start()].removesuffix(" in").rstrip(","), spelled
    return header, ""


def stated_unit(table: FileTable, header: str, kinds: tuple[str, ...]) -> tuple[str, bool]:
    """Return the unit that a file states for a column, and whether that can be read.

    It is returned in a spelling that the reader knows; nothing where the file states none.
    """
    given, end = table.units[header], split_unit(header)[1]
    # A letter at the end of a name may be a symbol: T_s.
    if not given and (len(end) > 1 or kind_of_unit(end, kinds)):
        given = end
    if not given:
        # "Mass fraction" implies the unit 1.
        named = "fraction" in kinds and "fraction" in header_key(header)
        return ("1" if named else "", True)
    plain = given.casefold().strip()
    spaceless = re.sub(r"[_ ./-]|1$", "", plain)
    for unit in (
        given,
        plain,
        plain.rstrip("."),
        _SPELLINGS.get(plain, ""),
        _SPELLINGS.get(spaceless, ""),
    ):
        if unit and kind_of_unit(unit, kinds):
            return unit, True
    return given, False


def guessed_unit(
    table: FileTable,
    quantity: Quantity,
    role: str,
    columns: Mapping[str, str],
    units: Mapping[str, str],
) -> str:
    """Return the unit that the numbers of a column look like."""
    numbers = table.columns[columns[role]]
    numbers = numbers[np.isfinite(numbers)]
    if role == "uncertainty":
        return units["value"]
    if role == "time":
        heated = columns.get("temperature")
        return "s" if heated is None else _time_unit(table, columns["time"], heated)
    if role == "temperature":
        return "degC" if numbers[0] < 200.0 else "K"
    return quantity.guess(float(numbers[0]), float(numbers.max()))


def _time_unit(table: FileTable, time_column: str, heated: str) -> str:
    """Return s or min, whichever makes the heating rate nearer to a usual one."""
    columns = np.array([table.columns[time_column], table.columns[heated]])
    time, temperature = columns[:, np.isfinite(columns).all(axis=0)]
    if len(time) < 2 or not (np.diff(time) > 0.0).all():
        return "s"
    with np.errstate(over="ignore", invalid="ignore"):  # an overflow is refused when it is read
        rate = max(_heating_rate(time, temperature), 1e-6)
    off = {
        unit: float(np.abs(functions.log(factor * rate / STANDARD_RATES)).min())
        for unit, factor in (("s", 60.0), ("min", 1.0))
    }
    return min(off, key=lambda unit: off[unit])


def _heating_rate(time: FloatArray, temperature: FloatArray) -> float:
    """Return the usual slope of a record, that of its heating where it is held for the most."""
    usual = float(np.median(np.gradient(temperature, time)))
    some = np.unique(np.linspace(0, time.size - 1, _INTERVALS).astype(int))
    slopes = np.diff(temperature[some]) / np.diff(time[some])
    if slopes.max() <= 0.0 or usual > _HELD * slopes.max():
        return usual
    return float(np.median(slopes[slopes >= 0.5 * slopes.max()]))
