"""A boundary condition over time from a table of a laboratory."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from pyrofit.data.csvfile import FloatArray, read_table
from pyrofit.errors import DataError, suggest
from pyrofit.quantities.units import SCALES, ZEROS_K, header_key, unit_key

ROLES = "time", "value"
TIME = "Time"
"""Header of the times that is recognised without being named."""


def read_time_table(
    path: Path, kind: str, columns: Mapping[str, str], units: Mapping[str, str]
) -> tuple[FloatArray, FloatArray]:
    """Return times [s] and values [SI] of a file, shape (n,) each; the first value holds from 0 on.

    Parameters
    ----------
    path
        The file, see `pyrofit.data.csvfile.read_table`.
    kind
        Kind of unit of the values, see `pyrofit.quantities.units.SCALES`.
    columns, units
        Header and unit by role, ``time`` and ``value``, where the file does not tell.

    Raises
    ------
    DataError
        The file cannot be read; a column or unit is unknown; times decrease or begin before 0.
    """
    for key, given in (("columns", columns), ("units", units)):
        for role in given:
            if role not in ROLES:
                raise DataError(
                    f"{path}: `{key}` names an unknown role '{role}'. {suggest(role, ROLES)}"
                )
    table = read_table(path)
    names = list(table.columns)
    time = _column(path, names, "time", columns.get("time"), [TIME])
    rest = [name for name in names if name != time]
    value = _column(path, rest, "value", columns.get("value"), rest)
    table.require([time, value])
    t, y = (
        _to_si(path, table.columns[name], units.get(role, table.units[name]), role, of)
        for name, role, of in ((time, "time", "time"), (value, "value", kind))
    )
    if t[0] < 0.0 or np.any(np.diff(t) < 0.0):
        raise DataError(
            f"{path}, column '{time}': times must not decrease, and not begin before 0, the start "
            "of the test; sort the rows, or delete those before it."
        )
    if t[0] > 0.0:
        t, y = np.append(0.0, t), np.append(y[0], y)
    return t, y


def _column(path: Path, names: list[str], role: str, asked: str | None, known: list[str]) -> str:
    """Return the header of a role: the one asked for, or the only one that is known."""
    wanted = {header_key(name) for name in ([asked] if asked else known)}
    found = [name for name in names if header_key(name) in wanted]
    if len(found) != 1:
        what = f"there is no column '{asked}'" if asked else f"{len(found)} columns may be"
        raise DataError(
            f"{path}: {what} the {role}; name the right one: `columns: {{{role}: ...}}`. "
            + (suggest(asked or role, names) if names else "The file has no further column.")
        )
    return found[0]


def _to_si(path: Path, given: FloatArray, unit: str | None, role: str, kind: str) -> FloatArray:
    words = {unit_key(word): word for word in SCALES[kind]}
    if not unit or unit_key(unit) not in words:
        what = f"unknown unit '{unit}'" if unit else "no unit"
        raise DataError(
            f"{path}: {what} of the {role}. {suggest(unit or '', words.values())} "
            f"Give it in the study: `units: {{{role}: ...}}`."
        )
    word = words[unit_key(unit)]
    return given * SCALES[kind][word] + ZEROS_K.get(word, 0.0)
