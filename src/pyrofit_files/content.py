"""The kind of experiment that the columns of a table show."""

from collections.abc import Iterable

import numpy as np

from pyrofit.data.csvfile import FileTable, FloatArray
from pyrofit.experiments import KINDS, OF_FILES
from pyrofit.new_study.columns import FoundColumn, Recognised, recognise
from pyrofit.numerics import fitting
from pyrofit.quantities.units import SCALES, unit_key

LARGEST_HEATED_KG = 1e-3
"""Mass from which on a sample is a slab, and not one in a crucible."""
_STRAIGHT = 0.02
"""Deviation of a temperature from a straight line over its range, of a programmed heating."""
_ORDER = "tga", "mcc", "dsc", "gasification", "cone"
"""Kinds from the one with the fewest columns on: of two that fit, the first is taken."""


def best_kind(table: FileTable, kind: str = "") -> tuple[str, Recognised]:
    """Return the kind of experiment that explains most columns, and its signals.

    Of kinds that explain as many, the size of the mass and the course of the temperature tell
    samples in a furnace from slabs.

    Parameters
    ----------
    table
        A measured file.
    kind
        The kind that the name of the file tells, or nothing. It is taken if it is a kind of the
        same sort: a slab, or a sample in a furnace. A gasification with a heat release rate is a
        test in a cone calorimeter.

    Examples
    --------
    >>> from pathlib import Path
    >>> t = np.arange(0.0, 60.0)
    >>> columns = {"t": t, "T": 30.0 + 10.0 * t, "m": 9.0 - 0.1 * t}
    >>> units = {"t": "min", "T": "C", "m": "mg"}
    >>> best_kind(FileTable(Path("BOARD_10.csv"), columns, units, 2))[0]
    'tga'
    """
    found = {name: recognise(table, name) for name in sorted(OF_FILES, key=_rank)}
    used = {name: _used(of) for name, of in found.items()}
    heated = [name for name in found if KINDS[name].stage == "kinetics"]
    slabs = [name for name in found if name not in heated]
    sort = _sort_of_mass(table, found.values(), heated, slabs)
    best = [name for name in sort if used[name] == max(used[n] for n in sort)]
    if set(heated) & set(best) and set(slabs) & set(best):
        in_furnace = _in_furnace(table, found[heated[0]])
        best = [name for name in best if (name in heated) == in_furnace]
    if kind not in found:
        return best[0], found[best[0]]
    named = [kind, *(n for n, of in OF_FILES.items() if kind == of.description.LIKE)]
    like = [n for n in named if KINDS[n].stage == KINDS[best[0]].stage]
    chosen = max(like, key=used.__getitem__) if like else best[0]
    chosen = kind if not used[chosen] else chosen
    return chosen, found[chosen]


def _rank(name: str) -> int:
    return _ORDER.index(name) if name in _ORDER else len(_ORDER)


def _readable(recognised: Recognised) -> list[FoundColumn]:
    """Return signals whose columns are known; a record against temperature may lack the times."""
    return [
        f
        for f in recognised.signals
        if not f.unread
        and (not f.missing or (f.missing == ("time",) and f.of.against_temperature and f.columns))
    ]


def _used(recognised: Recognised) -> int:
    """Return the number of columns that signals take."""
    return len({column for f in _readable(recognised) for column in f.columns.values()})


def _sort_of_mass(
    table: FileTable, tried: Iterable[Recognised], heated: list[str], slabs: list[str]
) -> list[str]:
    """Return the kinds of samples as heavy as that of a table; all where it tells no mass.

    A guessed unit tells none: a mass of 1 may be a fraction.
    """
    masses = {unit_key(word): factor for word, factor in SCALES["mass"].items()}
    for found in (found for recognised in tried for found in _readable(recognised)):
        column = found.columns["value"]
        unit = unit_key(found.units.get("value") or table.units[column] or "")
        if found.scale == "mass" and unit in masses and "value" not in found.guessed:
            largest = masses[unit] * float(np.nan_to_num(table.columns[column]).max())
            return heated if largest < LARGEST_HEATED_KG else slabs
    return [*heated, *slabs]


def _in_furnace(table: FileTable, recognised: Recognised) -> bool:
    """Tell whether a record is one of a mass fraction, or of a programmed temperature."""
    for found in _readable(recognised):
        if found.scale == "fraction":
            return True
        if {"time", "temperature"} <= found.columns.keys():
            return _straight(*(table.columns[found.columns[r]] for r in ("time", "temperature")))
    return False


def _straight(time: FloatArray, temperature: FloatArray) -> bool:
    known = np.isfinite(time) & np.isfinite(temperature)
    t, T = time[known], temperature[known]
    if t.size < 3 or np.ptp(t) == 0.0 or np.ptp(T) == 0.0:
        return False
    slope, level = fitting.polynomial(t - t[0], T, 1)
    off = T - (slope * (t - t[0]) + level)
    return bool(np.sqrt(np.mean(off**2)) < _STRAIGHT * np.ptp(T))
