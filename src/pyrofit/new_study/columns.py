"""Recognise the columns of a measured file, more widely than its reader does by itself."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from pyrofit.data.convert import OTHER_ZERO, stated_mass
from pyrofit.data.csvfile import FileTable
from pyrofit.data.stated import Stated
from pyrofit.data.suspect_mass import FALLEN, rows_of_median
from pyrofit.experiments import measurable
from pyrofit.new_study.abscissae import abscissa_candidates
from pyrofit.new_study.headers import is_error, is_usual, may_be, root_of_header, stem_of
from pyrofit.new_study.reasons import is_empty, is_stated_change, why_unused
from pyrofit.new_study.units import guessed_unit, kind_of_unit, kinds_of_units, stated_unit
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import SCALES, header_key, unit_key
from pyrofit.solver.arrays import FloatArray

_OWN = ("value", "uncertainty")
"""Roles that belong to one signal; the others are shared by all signals of a file."""
_LEAST_LEFT = 0.5
"""The least fraction that a drying leaves."""
_NEAR_ONE = 0.1
_NAMELESS = ("value", "signal", "y", "balance", "loadcell", "waage", "column2")
"""Headers of which the unit alone tells the quantity, or one that begins at 1 without a unit."""


@dataclass(frozen=True)
class FoundColumn:
    """A quantity that was found in a file.

    Parameters
    ----------
    signal
        Name of the signal: that of the quantity, numbered where a file has several.
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
    unread
        Unit by role that the file states and that is not known.
    scale
        Kind of unit of the value, see `pyrofit.quantities.units`; nothing where it is unknown.
    area_m2
        Exposed area of the sample [m2], where the file tells it.
    stated
        Further facts that the file states.
    tared
        Whether the zero of the masses is arbitrary.
    dried_to
        Mass fraction at which a record starts after a drying; None where it starts at the initial
        mass.
    begins_at
        The first mass over the initial mass that the file states, where it is below.
    """

    signal: str
    quantity: str
    columns: Mapping[str, str]
    units: Mapping[str, str]
    guessed: tuple[str, ...]
    missing: tuple[str, ...]
    unread: Mapping[str, str]
    scale: str
    area_m2: float | None = None
    stated: Stated = field(default_factory=Stated)
    tared: bool = False
    dried_to: float | None = None
    begins_at: float | None = None

    @property
    def of(self) -> Quantity:
        """The quantity."""
        return known_quantities()[self.quantity]


@dataclass(frozen=True)
class Recognised:
    """The signals of a file, those that show the mass loss first, and columns without a use.

    Parameters
    ----------
    signals
        The recognised signals.
    left
        Why a column is not taken, by header.
    timeless
        Whether no column may be the time.
    """

    signals: tuple[FoundColumn, ...]
    left: Mapping[str, str]
    timeless: bool = False


def recognise(table: FileTable, kind: str) -> Recognised:
    """Assign columns and units to the quantities of a kind of experiment.

    Names that the reader knows come before words that hold them. A unit is that of the file, else
    the end of a name as in `time_min`, else guessed from the numbers. Several columns of one
    temperature, told apart by a number, are a signal each.

    Examples
    --------
    >>> from pathlib import Path
    >>> columns = {"t": np.arange(3.0), "T_degC": np.array([20.0, 30.0, 40.0])}
    >>> columns["weight"] = np.array([100.0, 100.0, 99.0])
    >>> table = FileTable(Path("tga.csv"), columns, dict.fromkeys(columns), 2)
    >>> (found,) = recognise(table, "tga").signals
    >>> found.columns
    {'time': 't', 'temperature': 'T_degC', 'value': 'weight'}
    >>> found.units
    {'time': 'min', 'temperature': 'degC', 'value': '%'}
    """
    quantities = sorted(measurable(kind).values(), key=_rank)
    empty = [name for name in table.columns if is_empty(table, name)]
    roles = dict.fromkeys(r for q in quantities for r in q.roles if r not in _OWN)
    possible = {role: abscissa_candidates(table, quantities, role, empty) for role in roles}
    shared = {role: names[0] if len(names) == 1 else "" for role, names in possible.items()}
    taken = {*empty, *shared.values()}
    signals, left = _signals(table, [n for n in table.columns if n not in taken], quantities)
    signals = signals or {quantities[0].name: (quantities[0], "")}
    found = _all_found(table, signals, shared)
    used = {header for one in found for header in one.columns.values()}
    reasons = {n: left.get(n) or why_unused(table, n, kind) for n in table.columns if n not in used}
    return Recognised(found, reasons, timeless=not possible.get("time"))


def _rank(quantity: Quantity) -> tuple[bool, bool, bool, str]:
    """Order quantities: rates, then others that show a released mass, temperatures last."""
    return not quantity.relative, quantity.released is None, quantity.is_temperature, quantity.name


def _signals(
    table: FileTable, free: Sequence[str], quantities: Sequence[Quantity]
) -> tuple[dict[str, tuple[Quantity, str]], dict[str, str]]:
    """Return quantity and column of each signal, and why other columns are none."""
    claims: dict[str, list[str]] = {}
    left = {}
    for name in free:
        usual = [q.name for q in quantities if is_usual(name, q)]
        if not usual and stem_of(name) in _NAMELESS:
            unit = table.units[name] or _unit_one(table, name)
            usual = [q.name for q in quantities if kind_of_unit(unit, q.scales)]
        if is_stated_change(table, name):
            usual = [q.name for q in quantities if q.scales[0] == "fraction" and "mass" in q.scales]
        owners = usual or [q.name for q in quantities if may_be(name, q)]
        owners = _in_their_units(table.units[name], owners)
        if len(owners) == 1:
            claims.setdefault(owners[0], []).append(name)
        elif owners:
            left[name] = f"may be {' or '.join(owners)}; name it in the study where it is needed"
    signals = {}
    for quantity in quantities:
        names = claims.get(quantity.name, [])
        if quantity.place != "fixed":
            where = f"may be {quantity.name}, whose place no file tells; name it in the study"
            left |= dict.fromkeys(names, where)
            continue
        chosen = _chosen(table, names, quantity)
        for i, name in enumerate(chosen, start=1):
            label = quantity.name if len(chosen) == 1 else f"{quantity.name}_{i}"
            signals[label] = (quantity, name)
        other = f"may be {quantity.name} as well; name it in the study where it is needed"
        left |= {name: other for name in names if name not in chosen}
    return signals, left


def _in_their_units(unit: str | None, owners: list[str]) -> list[str]:
    """Return the quantities that a column's unit, if it is known, may be of."""
    if not kind_of_unit(unit or "", tuple(SCALES)):
        return owners
    of = known_quantities()
    return [name for name in owners if kind_of_unit(unit or "", of[name].scales)]


def _unit_one(table: FileTable, name: str) -> str:
    """Return 1 for a column without a unit that starts near 1 and never exceeds it by much."""
    values = table.columns[name][np.isfinite(table.columns[name])]
    falls = values.size and abs(values[0] - 1.0) < _NEAR_ONE and values.max() < 1.0 + _NEAR_ONE
    return "1" if falls and values.min() >= 0.0 else ""


def _chosen(table: FileTable, names: Sequence[str], quantity: Quantity) -> list[str]:
    """Return the columns that are signals of a quantity; none where it is not clear which are.

    Of several, the total comes first, beside parts such as a reversing heat flow, then one in the
    quantity's own unit: per area, not per sample.
    """
    first = [name for name in names if is_usual(name, quantity)] or list(names)
    if not quantity.is_temperature:
        totals = [name for name in first if stem_of(name).startswith("total")]
        if len(totals) == 1:
            return totals
        own = [n for n in first if kind_of_unit(table.units[n] or "", quantity.scales[:1])]
        return first if len(first) == 1 else own if len(own) == 1 else []
    roots = {root_of_header(name) for name in first}
    return [n for n in names if root_of_header(n) in roots] if len(roots) == 1 else []


def _columns(
    table: FileTable,
    quantity: Quantity,
    header: str,
    shared: Mapping[str, str],
    values: Sequence[str],
) -> dict[str, str]:
    """Return the columns of a signal by role; nothing where none, or more than one, may be it."""
    columns = {role: shared[role] for role in quantity.roles if role in shared}
    columns["value"] = header
    if header:
        free = [n for n in table.columns if n not in {*values, *shared.values()}]
        free = [n for n in free if np.nan_to_num(table.columns[n]).any()]
        usual = {header_key(name) for name in quantity.uncertainty_headers}
        errors, order = [n for n in free if header_key(n) in usual], list(table.columns)
        errors = errors or [n for n in free if is_error(n, quantity, header, order, values)]
        if len(errors) == 1:
            columns["uncertainty"] = errors[0]
    return columns


def _all_found(
    table: FileTable, signals: Mapping[str, tuple[Quantity, str]], shared: Mapping[str, str]
) -> tuple[FoundColumn, ...]:
    """Return all signals with their columns and units."""
    values = [header for _, header in signals.values()]
    return tuple(
        _found(table, signal, quantity, _columns(table, quantity, header, shared, values))
        for signal, (quantity, header) in signals.items()
    )


def _found(
    table: FileTable, signal: str, quantity: Quantity, headers: Mapping[str, str]
) -> FoundColumn:
    """Return a signal with its units, once its columns are known."""
    columns = {role: header for role, header in headers.items() if header}
    missing = tuple(role for role, header in headers.items() if not header)
    units: dict[str, str] = {}
    unread, guessed = {}, []
    # Time last: where it has no unit, the heating rate tells it.
    for role in sorted(columns, key=("temperature", "value", "uncertainty", "time").index):
        kinds = kinds_of_units(quantity, role)
        unit, read = stated_unit(table, columns[role], kinds)
        if role == "uncertainty" and not unit:
            unit, read = stated_unit(table, columns["value"], kinds)
        if unit and not read:
            unread[role] = unit
            continue
        units[role] = unit or guessed_unit(table, quantity, role, columns, units)
        if not unit:
            guessed.append(role)
    scale = kind_of_unit(units.get("value", ""), quantity.scales)
    written = {
        role: units[role]
        for role in columns
        if role in units
        and not kind_of_unit(table.units[columns[role]] or "", kinds_of_units(quantity, role))
    }
    return FoundColumn(
        signal,
        quantity.name,
        columns,
        written,
        tuple(guessed),
        missing,
        unread,
        scale,
        table.area_m2,
        table.stated,
        _is_tared(table, columns.get("value", ""), units.get("value", ""), scale),
        _dried_to(table, columns.get("value", ""), units.get("value", ""), quantity),
        _begins_at(table, columns.get("value", ""), units.get("value", ""), scale),
    )


def _dried_to(table: FileTable, header: str, unit: str, quantity: Quantity) -> float | None:
    """Return the mass fraction at which a record of fractions starts, where it is below 97 %."""
    fractions = {unit_key(word): factor for word, factor in SCALES["fraction"].items()}
    of_mass = quantity.scales[0] == "fraction" and "mass" in quantity.scales
    if not of_mass or not header or unit_key(unit) not in fractions:
        return None
    values = table.columns[header][np.isfinite(table.columns[header])]
    first = _start(values) * fractions[unit_key(unit)] if values.size else 1.0
    return round(first, 4) if _LEAST_LEFT < first <= FALLEN else None


def _is_tared(table: FileTable, header: str, unit: str, scale: str) -> bool:
    """Tell whether the first mass is not the initial mass that the file states."""
    masses = {unit_key(word): factor for word, factor in SCALES["mass"].items()}
    if scale != "mass" or unit_key(unit) not in masses:
        return False
    mass = table.columns[header] * masses[unit_key(unit)]
    stated = stated_mass(table, mass)
    return stated is not None and bool(abs(mass[0] - stated) > OTHER_ZERO * stated)


def _start(values: FloatArray) -> float:
    """Return the median of the first rows."""
    return float(np.nanmedian(values[: rows_of_median(values.size)]))


def _begins_at(table: FileTable, header: str, unit: str, scale: str) -> float | None:
    """Return the first mass over the stated initial mass, where it is a little below."""
    stated = table.stated.mass_kg if table.stated.mass_named else None
    if scale != "mass" or stated is None or _is_tared(table, header, unit, scale):
        return None
    factor = {unit_key(word): factor for word, factor in SCALES["mass"].items()}[unit_key(unit)]
    first = _start(table.columns[header]) * factor / stated
    return round(first, 4) if first <= FALLEN else None
