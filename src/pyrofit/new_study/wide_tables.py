"""Tables that hold several tests side by side, one heating rate a column.

One temperature stands before all masses, or one before each. The names of the masses tell the
rates. Such a table has no time, which follows from rate and temperature: t = (T - T_0) / beta.
"""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import Table, read_table
from pyrofit.experiments import KINDS
from pyrofit.new_study.headers import is_abscissa
from pyrofit.results.files import write_csv
from pyrofit.solver.arrays import FloatArray

_RATE = re.compile(r"\d+(?:[.,]\d+)?")
_LEAST_LOST = 0.02
"""Share of its first value that a mass loses at least."""
Test = tuple[str, str, float]
"""Headers of temperature and mass, and the heating rate [K/min]."""


def split(kind: str, path: Path, folder: Path) -> list[Path]:
    """Return the files of the tests in a table, written to a folder.

    The table itself, if it does not hold several.

    Raises
    ------
    DataError
        The file is no table of numbers.
    """
    if KINDS[kind].stage != "kinetics":
        return [path]
    table = read_table(path)
    tests = _tests(table)
    return list(_written(table, tests, folder)) if len(tests) > 1 else [path]


def _tests(table: Table) -> list[Test]:
    """Return the tests of a table without a time; none if they are not clear."""
    names = list(table.columns)
    if any(is_abscissa(name, "time") for name in names):
        return []
    temperatures = [name for name in names if is_abscissa(name, "temperature")]
    masses = [n for n in names if n not in temperatures and _falls(table.columns[n])]
    if len(temperatures) == 1:
        pairs = [(temperatures[0], mass) for mass in masses]
    elif len(temperatures) == len(masses):
        pairs = list(zip(temperatures, masses, strict=True))
    else:
        return []
    rates = [_rate(mass) for _, mass in pairs]
    if None in rates or len(set(rates)) < len(rates):
        return []
    return [(T, mass, rate) for (T, mass), rate in zip(pairs, rates, strict=True) if rate]


def _falls(values: FloatArray) -> bool:
    numbers = values[~np.isnan(values)]
    return numbers.size > 1 and numbers[-1] < (1.0 - _LEAST_LOST) * numbers[0]


def _rate(header: str) -> float | None:
    """Return the only number of a header.

    >>> _rate("rate_10"), _rate("m 2,5 K/min"), _rate("mass"), _rate("run 2, 10 K/min")
    (10.0, 2.5, None, None)
    """
    found = _RATE.findall(header)
    return float(found[0].replace(",", ".")) if len(found) == 1 else None


def _written(table: Table, tests: Sequence[Test], folder: Path) -> Iterator[Path]:
    for temperature, mass, rate in tests:
        T, m = table.columns[temperature], table.columns[mass]
        rows = ~(np.isnan(T) | np.isnan(m))
        T, m = T[rows], m[rows]
        per_K = 5.0 / 9.0 if "F" in (table.units[temperature] or "") else 1.0
        columns = {
            "Time (s)": (T - T[0]) * per_K * 60.0 / rate,
            _header("Temperature", table.units[temperature]): T,
            _header("Mass", table.units[mass]): m,
        }
        path = folder / f"{table.path.stem}_{rate:g}K.csv"
        write_csv(path, pd.DataFrame(columns))
        yield path


def _header(name: str, unit: str | None) -> str:
    return f"{name} ({unit})" if unit else name
