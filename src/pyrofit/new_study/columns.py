"""Recognise the columns of a measured file, more widely than its reader does by itself."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pyrofit.data.csvfile import Table
from pyrofit.quantities import known_quantities
from pyrofit.quantities.units import SCALES, header_key, unit_key

_UNIT_WORDS = {
    "sec": "s",
    "secs": "s",
    "seconds": "s",
    "mins": "min",
    "minutes": "min",
    "hours": "h",
    "kelvin": "K",
    "celsius": "degC",
    "°c": "degC",
    "c": "degC",
    "k": "K",
    "percent": "%",
    "pct": "%",
    "wt%": "%",
    "wt.%": "%",
    "gm2s": "g/m2/s",
    "kgm2s": "kg/m2/s",
}
"""Spellings of units that the reader does not know."""
_SUFFIX = re.compile(
    r"[_ ]((?:k|m)?g[_ ./]*m-?2[_ ./]*s(?:-?1)?|(?:s|sec|secs|seconds|min|mins|minutes|h"
    r"|hours|k|kelvin|deg_?c|c|celsius|mg|kg|g|pct|percent))$",
    re.IGNORECASE,
)
_ERROR = re.compile(r"err(or)?|unc(ertainty)?|sigma|std(ev|dev)?|deviation|sd$")
_WORDS = {
    "time": r"time.*|(elapsed|test)time|zeit",
    "temperature": r"(sample|program|furnace)?temp.*|ts",
}
_STANDARD_RATES = np.array([1, 2, 3, 5, 10, 15, 20, 25, 30, 40, 50, 80, 100.0])


@dataclass(frozen=True)
class Found:
    """What a file holds of one quantity.

    Parameters
    ----------
    quantity
        Name of a quantity.
    columns
        Header by role.
    units
        Unit by role, where the file does not give it in a way that its reader knows.
    guessed
        Roles whose unit is inferred from the numbers.
    missing
        Roles that no column, or more than one, may have.
    """

    quantity: str
    columns: Mapping[str, str]
    units: Mapping[str, str]
    guessed: tuple[str, ...]
    missing: tuple[str, ...]


def recognise(table: Table, quantity: str) -> Found:
    """Tell which column of a table is what, and in which unit.

    Names that the reader knows come first, then words that hold them. A unit is that of the
    file, else the end of a name as in `time_min`, else guessed from the numbers.

    Examples
    --------
    >>> from pathlib import Path
    >>> columns = {"t": np.arange(3.0), "T_degC": np.array([20.0, 30.0, 40.0])}
    >>> columns["weight"] = np.array([100.0, 100.0, 99.0])
    >>> table = Table(Path("tga.csv"), columns, dict.fromkeys(columns), 2)
    >>> found = recognise(table, "mass_fraction")
    >>> found.columns
    {'time': 't', 'temperature': 'T_degC', 'value': 'weight'}
    >>> found.units
    {'time': 'min', 'temperature': 'degC', 'value': '%'}
    """
    columns: dict[str, str] = {}
    missing = []
    for role in known_quantities()[quantity].roles:
        if role == "uncertainty" and "value" not in columns:
            continue
        matches = _matches(table, quantity, role, columns)
        if len(matches) == 1:
            columns[role] = matches[0]
        elif role != "uncertainty":
            missing.append(role)
    units: dict[str, str] = {}
    guessed = []
    # Time last: where it has no unit, the heating rate tells it.
    for role in sorted(columns, key=("temperature", "value", "uncertainty", "time").index):
        kinds = known_quantities()[quantity].scales if role in ("value", "uncertainty") else (role,)
        if _known(table.units[columns[role]], kinds):
            continue
        unit = _unit(table, columns[role], kinds)
        if role == "uncertainty" and not unit:
            unit = _unit(table, columns["value"], kinds)
        units[role] = unit or _guess(table, quantity, role, columns, units)
        if not unit:
            guessed.append(role)
    ordered = {role: units[role] for role in columns if role in units}
    return Found(quantity, columns, ordered, tuple(guessed), tuple(missing))


def _matches(table: Table, quantity: str, role: str, taken: Mapping[str, str]) -> list[str]:
    """Return the columns that may have a role, those with a usual name before others."""
    free = [
        name
        for name, numbers in table.columns.items()
        if name not in taken.values() and (role == "time" or np.nan_to_num(numbers).any())
    ]
    usual = {header_key(name) for name in known_quantities()[quantity].roles[role]}
    if known := [name for name in free if header_key(name) in usual]:
        return known
    return [name for name in free if _is(name, quantity, role)]


def _is(name: str, quantity: str, role: str) -> bool:
    """Tell whether the words of a header are those of a role."""
    stem, of = _stem(name), known_quantities()[quantity]
    if role == "uncertainty":
        rest, errors = _ERROR.subn("", stem)
        return bool(errors) and (not rest or bool(re.fullmatch(of.pattern, rest)))
    if _ERROR.search(stem):
        return False
    if stem == "t":  # the symbols: t for time, T for a temperature
        symbol = "time" if name.startswith("t") else "temperature"
        hot = role == "value" and of.is_temperature
        return role == symbol or (hot and symbol == "temperature")
    return bool(re.fullmatch(of.pattern if role == "value" else _WORDS[role], stem))


def _stem(name: str) -> str:
    return header_key(_SUFFIX.sub("", name))


def _known(unit: str | None, kinds: tuple[str, ...]) -> bool:
    """Tell whether the reader knows a unit."""
    known = {unit_key(word) for kind in kinds for word in SCALES[kind]}
    return unit is not None and unit_key(unit) in known


def _unit(table: Table, name: str, kinds: tuple[str, ...]) -> str:
    """Return the unit of a column in a spelling that the reader knows; nothing where none is."""
    suffix = _SUFFIX.search(name)
    for given in (table.units[name], suffix and suffix[1]):
        if given:
            plain = re.sub(r"deg_?c", "degC", given, flags=re.IGNORECASE)
            word = plain.casefold().strip()
            spelled = re.sub(r"[_ ./-]|1$", "", word)
            for unit in (plain, word, _UNIT_WORDS.get(word), _UNIT_WORDS.get(spelled)):
                if unit and _known(unit, kinds):
                    return unit
    return "1" if "fraction" in kinds and "fraction" in _stem(name) else ""


def _guess(
    table: Table,
    quantity: str,
    role: str,
    columns: Mapping[str, str],
    units: Mapping[str, str],
) -> str:
    """Return the unit that the numbers look like."""
    numbers = table.columns[columns[role]]
    numbers = numbers[np.isfinite(numbers)]
    if role == "uncertainty":
        return units["value"]
    if role == "time":
        heated = columns.get("temperature")
        return "s" if heated is None else _time_unit(table, columns["time"], heated)
    if role == "temperature":
        return "degC" if numbers[0] < 200.0 else "K"
    return known_quantities()[quantity].guess(float(numbers[0]), float(numbers.max()))


def _time_unit(table: Table, time_column: str, heated: str) -> str:
    """Return s or min, whichever makes the heating rate nearer to a usual one."""
    columns = np.array([table.columns[time_column], table.columns[heated]])
    time, temperature = columns[:, np.isfinite(columns).all(axis=0)]
    if len(time) < 2 or not (np.diff(time) > 0.0).all():
        return "s"
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused when it is read
        rate = max(float(np.median(np.gradient(temperature, time))), 1e-6)
    off = {
        unit: float(np.abs(np.log(factor * rate / _STANDARD_RATES)).min())
        for unit, factor in (("s", 60.0), ("min", 1.0))
    }
    return min(off, key=lambda unit: off[unit])
