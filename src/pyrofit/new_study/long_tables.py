"""Tables that hold several tests below each other, which a column of numbers tells apart."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import FileTable
from pyrofit.experiments import KINDS
from pyrofit.new_study.headers import is_abscissa
from pyrofit.results.files import write_csv

_LABEL = re.compile(
    r"(test|run|sample|specimen|repeat|replicate|experiment|exp|curve|probe|versuch|lauf|messung)"
    r"[\W_]*(no\.?|nr\.?|number|id)?[\W_]*",
    re.I,
)
_RATE = re.compile(r"(heating[\W_]*)?rate|beta|heizrate", re.I)
_FLUX = re.compile(r"(heat[\W_]*)?flux|irradiance", re.I)
_FEWEST = 5
"""Rows of a test."""


def split_rows(kind: str, table: FileTable, folder: Path) -> list[Path]:
    """Return the files of tests that stand below each other, written to a folder.

    None where no one column is a number or a rate of the test that changes where the times start
    anew.
    """
    times = [name for name in table.columns if is_abscissa(name, "time")]
    labels = [name for name in table.columns if _ending(kind, name) is not None]
    if len(times) != 1 or len(labels) != 1:
        return []
    tests = list(_tests(table.columns[times[0]], table.columns[labels[0]]))
    if len(tests) < 2:
        return []
    return [_written(kind, table, labels[0], number, rows, folder) for number, rows in tests]


def _ending(kind: str, header: str) -> str | None:
    """Return what stands behind the number of a test in the name of its file."""
    number = {"kinetics": (_RATE, "K"), "imp": (_FLUX, "kW")}[KINDS[kind].stage]
    if number[0].fullmatch(header):
        return number[1]
    return "" if _LABEL.fullmatch(header) else None


def _tests(time: np.ndarray, label: np.ndarray) -> Iterator[tuple[float, slice]]:
    """Yield number and rows of each test; none where times and numbers disagree.

    >>> t = np.tile(np.arange(5.0), 2)
    >>> list(_tests(t, np.repeat([1.0, 2.0], 5)))
    [(1.0, slice(0, 5, None)), (2.0, slice(5, 10, None))]
    >>> list(_tests(t, np.ones(10)))
    []
    """
    starts = np.flatnonzero(np.diff(label) != 0.0) + 1
    anew = np.flatnonzero(np.diff(time) < 0.0) + 1
    edges = [0, *starts.tolist(), label.size]
    numbers = label[edges[:-1]]
    whole = np.diff(edges).min() >= _FEWEST and np.unique(numbers).size == numbers.size
    if np.isnan(label).any() or not whole or not set(anew) <= set(starts) or not anew.size:
        return
    for number, first, end in zip(numbers, edges, edges[1:], strict=False):
        yield float(number), slice(first, end)


def _written(
    kind: str, table: FileTable, label: str, number: float, rows: slice, folder: Path
) -> Path:
    frame = {
        f"{name} ({unit})" if (unit := table.units[name]) else name: column[rows]
        for name, column in table.columns.items()
        if name != label
    }
    ending = _ending(kind, label)
    name = f"{number:g}{ending}" if ending else f"run{number:g}"
    path = folder / f"{table.path.stem}_{name}.csv"
    write_csv(path, pd.DataFrame(frame))
    return path
