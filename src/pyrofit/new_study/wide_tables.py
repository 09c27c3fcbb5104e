"""Tables that hold several tests side by side, each in columns of its own.

The names of the columns, or the row above them, tell the tests: by a heating rate or a flux with
its unit, or by a number.
The numbers that tell columns of one name apart do as well. Columns without a number belong to all.
Where a table of heated samples has no time, that follows from rate and temperature.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from string import ascii_lowercase
from typing import Literal

import numpy as np
import pandas as pd

from pyrofit.data.blocks import Block
from pyrofit.data.csvfile import FileTable, read_table
from pyrofit.experiments import KINDS, files_of, measurable
from pyrofit.new_study.headers import is_abscissa
from pyrofit.new_study.long_tables import split_rows
from pyrofit.results.files import write_csv
from pyrofit.solver.arrays import FloatArray

_NUMBER = r"(\d+(?:[.,]\d+)?)"
_RATE_WORD = re.compile(rf"(?:rate|beta|hr|heizrate)[\s_-]*{_NUMBER}", re.IGNORECASE)
_LAST = re.compile(rf"[\s_(-]*{_NUMBER}\)?$")
_LEAST_LOST = 0.02
"""Share of its first value that a mass loses at least."""
How = Literal["unit", "number", "index"]
"""What tells a test: a number with its unit, a number alone, or one that tells names apart."""


@dataclass(frozen=True)
class HeaderLabel:
    """What the name of a column tells of its test: the rest of the name, and the number."""

    rest: str
    number: float
    how: How


@dataclass(frozen=True)
class PartOfTable:
    """The columns of a test by their new headers; time [s] is computed where rate is given."""

    number: float
    how: How
    columns: Mapping[str, str]
    rate_K_min: float | None = None


def split_table(kind: str, path: Path, folder: Path) -> list[Path]:
    """Return the files of the tests in a table, side by side or below each other, in a folder.

    The table itself, if it does not hold several.

    Raises
    ------
    DataError
        The file is no table of numbers.
    """
    table = read_table(path)
    tests = _tests(kind, table)
    if len(tests) > 1:
        labels = _labels(kind, tests)
        return [_written(kind, table, *each, folder) for each in zip(tests, labels, strict=True)]
    return split_rows(kind, table, folder) or [path]


def label_of_header(kind: str, header: str) -> HeaderLabel | None:
    """Return what a header tells of its test; None where it tells nothing.

    >>> label_of_header("tga", "m 2,5 K/min")
    HeaderLabel(rest='m', number=2.5, how='unit')
    >>> label_of_header("tga", "Mass (2)")
    HeaderLabel(rest='Mass', number=2.0, how='index')
    >>> label_of_header("cone", "HRR 50kW"), label_of_header("cone", "TC 1")
    (HeaderLabel(rest='HRR', number=50.0, how='unit'), None)
    """
    unit = files_of(kind).number.unit
    with_unit = re.compile(
        rf"[\s_(-]*(?<![\d.,]){_NUMBER}[\s_-]*(?:{unit})(/?m\^?[2²])?(?![A-Za-z])\)?"
    )
    heated = KINDS[kind].stage == "kinetics"
    for pattern in (with_unit, *([_RATE_WORD] if heated else [])):
        found = list(pattern.finditer(header))
        if len(found) == 1:
            rest = header[: found[0].start()] + header[found[0].end() :]
            return HeaderLabel(rest.strip(" _-"), _value(found[0][1]), "unit")
    last = _LAST.search(header)
    if not heated or last is None:
        return None
    how: How = "index" if header.endswith(")") else "number"
    return HeaderLabel(header[: last.start()].strip(" _-"), _value(last[1]), how)


def _value(text: str) -> float:
    return float(text.replace(",", "."))


def _tests(kind: str, table: FileTable) -> list[PartOfTable]:
    """Return the tests of a table; none if they are not clear."""
    blocks = _clear(_test_of_block(kind, table, block) for block in table.blocks)
    if blocks:
        return blocks
    labels = {name: label_of_header(kind, name) for name in table.columns}
    own = {name: label for name, label in labels.items() if label is not None}
    shared = [name for name in table.columns if name not in own]
    if KINDS[kind].stage == "kinetics":
        own, shared = _paired(own, shared)
    groups: dict[tuple[float, How], dict[str, str]] = {}
    for name, label in own.items():
        columns = groups.setdefault((label.number, label.how), {})
        if label.rest in columns:
            return []
        columns[label.rest] = name
    rests = [set(columns) for columns in groups.values()]
    if len(groups) < 2 or any(rest != rests[0] for rest in rests):
        return []
    return _clear(_test(kind, table, key, columns, shared) for key, columns in groups.items())


def _clear(given: Iterable[PartOfTable | None]) -> list[PartOfTable]:
    """Return the tests if all are clear."""
    tests = list(given)
    return [test for test in tests if test is not None] if None not in tests else []


def _test_of_block(kind: str, table: FileTable, block: Block) -> PartOfTable | None:
    """Return the test of a block; a number that no unit and no word make a rate tells no rate."""
    label = label_of_header(kind, block.label)
    alone = re.fullmatch(_NUMBER, block.label)
    key: tuple[float, How] = (0.0, "index")
    if label is not None and (label.how == "unit" or alone):
        key = label.number, label.how
    return _test(kind, table, key, block.columns, [])


def _paired(
    own: Mapping[str, HeaderLabel], shared: list[str]
) -> tuple[dict[str, HeaderLabel], list[str]]:
    """Give each of as many temperatures as masses to the mass of its place.

    The names of the temperatures are the same but for a number that tells them apart.
    """
    temperatures = [n for n in (*own, *shared) if is_abscissa(_rest(own, n), "temperature")]
    others = [n for n in own if n not in temperatures]
    told_apart = all(n in own and own[n].how == "index" for n in temperatures)
    by_place = (
        told_apart
        and len(temperatures) == len(others)
        and any(own[n].how != "index" for n in others)
    )
    if not by_place:
        return dict(own), shared
    pairs = zip(temperatures, others, strict=True)
    given = {T: HeaderLabel(own[T].rest, own[m].number, own[m].how) for T, m in pairs}
    return {**own, **given}, shared


def _rest(own: Mapping[str, HeaderLabel], name: str) -> str:
    return own[name].rest if name in own else name


def _test(
    kind: str,
    table: FileTable,
    key: tuple[float, How],
    columns: Mapping[str, str],
    shared: list[str],
) -> PartOfTable | None:
    """Return a test, or None where its columns are not those of one."""
    number, how = key
    named = {name: name for name in shared} | dict(columns)
    if KINDS[kind].stage != "kinetics":
        return PartOfTable(number, how, named) if all(columns) else None
    times = [n for n in named if is_abscissa(n, "time")]
    temperatures = [n for n in named if is_abscissa(n, "temperature")]
    values = [n for n in named if n not in (*times, *temperatures)]
    only_mass = len(measurable(kind)) == 1
    if only_mass:
        values = [n for n in values if _falls(table.columns[named[n]])]
    if len(temperatures) != 1 or len(times) > 1 or (times and times[0] in shared):
        return None
    if not values or (only_mass and len(values) != 1) or not set(values) - set(shared):
        return None
    own = {"Time": named[times[0]]} if times else {}
    own["Temperature"] = named[temperatures[0]]
    own |= {"Mass" if only_mass else n: named[n] for n in values if n not in shared}
    if how == "index" and temperatures[0] in shared:
        return None
    return PartOfTable(number, how, own, number if not times and how == "unit" else None)


def _falls(values: FloatArray) -> bool:
    numbers = values[~np.isnan(values)]
    return numbers.size > 1 and bool(numbers[-1] < (1.0 - _LEAST_LOST) * numbers[0])


def _labels(kind: str, tests: Sequence[PartOfTable]) -> list[str]:
    """Return what tells the file of each test: its number, with that of a repeat, or a letter."""
    ending = {"kinetics": "K", "imp": "kW"}[KINDS[kind].stage]
    numbers = [f"{test.number:g}{ending if test.how == 'unit' else ''}" for test in tests]
    labels = []
    for k, (test, number) in enumerate(zip(tests, numbers, strict=True)):
        repeat = f"_R{numbers[:k].count(number) + 1}" if numbers.count(number) > 1 else ""
        # A number that only tells columns apart must not be taken for a heating rate.
        labels.append(_letters(k) if test.how == "index" else f"{number}{repeat}")
    return labels


def _written(kind: str, table: FileTable, test: PartOfTable, label: str, folder: Path) -> Path:
    columns = {new: table.columns[name] for new, name in test.columns.items()}
    rows = ~np.any([np.isnan(column) for column in columns.values()], axis=0)
    frame: dict[str, FloatArray] = {}
    if test.rate_K_min is not None:
        T, unit = columns["Temperature"][rows], table.units[test.columns["Temperature"]]
        per_K = 5.0 / 9.0 if "F" in (unit or "") else 1.0
        frame["Time (s)"] = (T - T[0]) * per_K * 60.0 / test.rate_K_min
    for new, name in test.columns.items():
        frame[_header(new, _unit_of(kind, table, name))] = columns[new][rows]
    path = folder / f"{table.path.stem}_{label}.csv"
    write_csv(path, pd.DataFrame(frame))
    return path


def _letters(place: int) -> str:
    """Return a name of a test by its place from 0.

    >>> _letters(0), _letters(1), _letters(26)
    ('a', 'b', 'aa')
    """
    turns, letter = divmod(place, 26)
    return (_letters(turns - 1) if turns else "") + ascii_lowercase[letter]


def _unit_of(kind: str, table: FileTable, name: str) -> str | None:
    """Return the unit of a column; that of a heating rate in its name is none."""
    unit, label = table.units[name], label_of_header(kind, name)
    of_rate = unit and label is not None and unit in name and unit not in label.rest
    return None if of_rate else unit


def _header(name: str, unit: str | None) -> str:
    return f"{name} ({unit})" if unit else name
