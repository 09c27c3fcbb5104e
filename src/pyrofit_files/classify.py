"""Identify a measured file, and read its signals."""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.convert import to_si
from pyrofit.data.csvfile import FileTable, read_table
from pyrofit.data.spec import SeriesSpec
from pyrofit.errors import DataError
from pyrofit.experiments import KINDS
from pyrofit.experiments.heated.from_files import recorded_rate
from pyrofit.new_study.columns import FoundColumn
from pyrofit.quantities.units import ICE_POINT_K, header_key, unit_key
from pyrofit_files.content import best_kind
from pyrofit_files.examined import Examined, FileSignal
from pyrofit_files.names import Label, label_of
from pyrofit_files.readme import read_readme, stated_facts

_PER_METRE = {"cm-1": 100.0, "1/cm": 100.0, "/cm": 100.0}
_DIFFUSIVITY = {"mm2/s": 1e-6, "m2/s": 1.0, "cm2/s": 1e-4}
_TEMPERATURE = {"k": 0.0, "degc": ICE_POINT_K, "c": ICE_POINT_K, "°c": ICE_POINT_K}
_FRACTION = {"-": 1.0, "1": 1.0, "%": 0.01}


def property_signals(table: FileTable) -> tuple[str, dict[str, FileSignal]]:
    """Return kind and signals of a table of a property; nothing where it is none.

    Known are a reflectivity against wavenumber and a thermal diffusivity against temperature.
    """
    by_key = {header_key(name): name for name in table.columns}
    for kind, abscissa, value in (
        ("reflectivity", "wavenumber", "reflectivity"),
        ("diffusivity", "temperature", "diffusivity"),
    ):
        x = by_key.get(abscissa)
        y = next((name for key, name in by_key.items() if key.endswith(value)), None)
        if x is None or y is None:
            continue
        signal = _signal(table, kind, x, y)
        return kind, {} if signal is None else {kind: signal}
    return "", {}


def _signal(table: FileTable, kind: str, x: str, y: str) -> FileSignal | None:
    units = {name: unit_key(table.units[name] or "") for name in (x, y)}
    if kind == "reflectivity":
        factor, scale = _PER_METRE.get(units[x]), _FRACTION.get(units[y])
        offset: float | None = 0.0
    else:
        factor, scale = 1.0, _DIFFUSIVITY.get(units[y])
        offset = _TEMPERATURE.get(units[x])
    if factor is None or scale is None or offset is None:
        return None
    values = table.columns[x] * factor + offset, table.columns[y] * scale
    known = np.isfinite(values).all(axis=0)
    unit = table.units[y] or ""
    return FileSignal(kind, y, unit, kind, values[0][known], values[1][known])


_TOTAL = "total"


def examine_file(path: Path) -> Examined:
    """Read a file as far as possible; report each obstacle as a finding.

    The columns tell the kind of experiment; the name tells it among kinds of the same sort. Facts
    are those of the README beside it.
    """
    label = label_of(path.stem, path.parent.name)
    seen = Examined(path, label, stated_facts(label, read_readme(path.parent)))
    try:
        seen.table = read_table(path)
    except DataError as error:
        seen.say("unreadable", "fault", _without_path(error, path))
        return seen
    for note in seen.table.mended:
        seen.say("mended", "note", note)
    kind, signals = property_signals(seen.table)
    if kind:
        seen.kind, seen.signals = kind, signals
        return seen
    seen.table = _named(seen.table)
    seen.kind, recognised = best_kind(seen.table, label.kind)
    if _contradicts(label.kind, seen.kind):
        seen.say(
            "kind", "fault", f"the name says {label.kind}, the columns are those of a {seen.kind}"
        )
    for found in recognised.signals:
        _take(seen, found)
    seen.left = {n: w for n, w in recognised.left.items() if _used(seen, n)}
    if not label.kind and seen.signals:
        seen.label = _with_facts(seen)
    return seen


def _with_facts(seen: Examined) -> Label:
    """Return the label of a file whose name tells no kind, with what the file itself tells."""
    assert seen.table is not None
    stated = seen.table.stated
    T = next((s for s in seen.signals.values() if s.temperature_K is not None), None)
    frame = {} if T is None else {"time_s": T.x, "temperature_K": T.temperature_K}
    rate = recorded_rate(0.0, {"": pd.DataFrame(frame)}) if frame else None
    return replace(
        seen.label, kind=seen.kind, gas=stated.gas, heating_K_min=rate, flux_kW_m2=stated.flux_kW_m2
    )


def _named(table: FileTable) -> FileTable:
    """Return the table with units out of the middle of names, and one total among several parts."""
    totals = [n for n in table.columns if n.casefold().startswith(_TOTAL)]
    parts = [n for n in table.columns if "reversing" in n.casefold()]
    if len(totals) == 1 and parts:
        columns = {n: c for n, c in table.columns.items() if n not in parts}
        name = "Heat Flow"
        columns = {name if n == totals[0] else n: c for n, c in columns.items()}
        units = {n: "W/g" if n == name else table.units[n] for n in columns}
        return replace(table, columns=columns, units=units)
    return table


def _contradicts(named: str, kind: str) -> bool:
    """Tell whether a slab is named as a sample in a furnace, or the reverse."""
    return named in KINDS and KINDS[named].stage != KINDS[kind].stage


def _take(seen: Examined, found: FoundColumn) -> None:
    """Add a signal to an examined file, or say why it cannot be read."""
    table = seen.table
    assert table is not None
    if found.missing:
        if len(found.missing) < len(found.of.roles):
            missing = " and ".join(found.missing)
            seen.say("columns", "fault", f"{found.quantity}: no one column is the {missing}")
        return
    header = found.columns["value"]
    for role, unit in found.unread.items():
        seen.say("unit", "fault", f"unknown unit '{unit}'", found.columns[role])
    if found.unread:
        return
    for role in found.guessed:
        text = f"no unit; the numbers look like {found.units[role]}"
        seen.say("unit", "doubt", text, found.columns[role])
    spec = SeriesSpec(found.quantity, seen.path, found.columns, found.units)
    columns = found.columns
    if text := _without_numbers(table, columns.values()):
        seen.say("unreadable", "fault", text, header)
        return
    arrays = [to_si(spec, table, columns, "time", ("time",))[0]]
    y, scale = to_si(spec, table, columns, "value", found.of.scales)
    arrays.append(y)
    if "temperature" in columns:
        arrays.append(to_si(spec, table, columns, "temperature", ("temperature",))[0])
    known = np.isfinite(arrays).all(axis=0)
    if not known.any():
        seen.say("gaps", "fault", "no row holds all of its cells", header)
        return
    x, y, *T = (array[known] for array in arrays)
    unit = table.units[header] or ""
    heated = T[0] if T else None
    seen.signals[found.signal] = FileSignal(found.quantity, header, unit, scale, x, y, heated)


def _without_path(error: DataError, path: Path) -> str:
    """Return the words of an error behind the name of the file."""
    return str(error).removeprefix(f"{path}").lstrip(",: ")


def _without_numbers(table: FileTable, names: Iterable[str]) -> str:
    """Return the fault of the first column that holds text alone; nothing where there is none."""
    for name in names:
        if np.isnan(table.columns[name]).all() and name in table.faults:
            try:
                table.require([name])
            except DataError as error:
                return _without_path(error, table.path)
    return ""


def _used(seen: Examined, name: str) -> bool:
    """Tell whether a column that is not a signal is worth a word."""
    return name not in {signal.header for signal in seen.signals.values()}
