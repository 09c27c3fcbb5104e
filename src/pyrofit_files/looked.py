"""Measured files as they are understood, grouped to tests, before there is a study."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.analysis.differing_repeats import lines_on_repeats
from pyrofit.errors import DataError
from pyrofit.new_study.repeats import root_of
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import PER_START
from pyrofit_files.checks import run_checks
from pyrofit_files.classify import examine_file
from pyrofit_files.examined import Examined, FileSignal, FloatArray

_MORE = "`pyrofit init NAME --tga FILE` also reads tables of several tests, and files without times"
FIRST = 5
"""Points whose median is the initial value."""
POINTS = 150
"""Points of a derivative, which smooths it."""


@dataclass(frozen=True, eq=False)
class Series:
    """A quantity of a test: the record of each repeat.

    Parameters
    ----------
    name
        Name of the test: that of its files without the number of the repeat.
    kind
        Kind of experiment.
    quantity
        The quantity; none where it is one that no experiment of a study measures.
    records
        Name of the file and signal of each repeat.
    """

    name: str
    kind: str
    quantity: Quantity | None
    records: tuple[tuple[str, FileSignal], ...]

    @property
    def frames(self) -> list[pd.DataFrame]:
        """The records as tables, SI units."""
        column = self.quantity.column if self.quantity else "value"
        found = []
        for _, signal in self.records:
            columns = {"time_s": signal.x, column: self.values(signal)}
            if signal.temperature_K is not None:
                columns["temperature_K"] = signal.temperature_K
            found.append(pd.DataFrame(columns))
        return found

    @property
    def scale(self) -> str:
        """Kind of unit of its values: that of the file, or a fraction of the initial value."""
        scale = self.records[0][1].scale
        of = self.quantity
        relative = of is not None and of.scales[0] == PER_START.get(scale)
        return PER_START[scale] if relative else scale

    def values(self, signal: FileSignal) -> FloatArray:
        """Return values of a record in SI units; masses of a heated sample over the initial one."""
        if self.scale == signal.scale:
            return signal.y
        return np.asarray(signal.y / np.median(signal.y[:FIRST]))

    @property
    def disagreements(self) -> list[str]:
        """A line for each repeat that differs from the others."""
        if self.quantity is None:
            return []
        return lines_on_repeats(self.quantity, [name for name, _ in self.records], self.frames)

    @property
    def loses(self) -> bool:
        """Whether it is a mass, whose derivative is shown beside it."""
        of = self.quantity
        return of is not None and (of.sampling == "cumulative" or of.scales[0] == "fraction")


@dataclass(frozen=True, eq=False)
class Looked:
    """Measured files as they are understood.

    Parameters
    ----------
    files
        The files as they were examined.
    tests
        Their tests, by quantity.
    """

    files: Sequence[Examined]
    tests: Sequence[Series]

    def lines(self) -> Iterator[str]:
        """Yield what was understood of each file, its faults, and repeats that disagree."""
        for seen in self.files:
            signals = ", ".join(_words(signal) for signal in seen.signals.values())
            kind = seen.kind or "unknown kind"
            yield f"{seen.path}: {kind}; {signals or 'nothing recognised'}"
            for found in seen.findings:
                if found.weight != "note":
                    where = f"column '{found.column}': " if found.column else ""
                    yield f"  {found.weight}: {where}{found.text}"
            if not seen.signals:
                yield f"  {_MORE}"
        for test in self.tests:
            if len(test.records) > 1:
                names = ", ".join(name for name, _ in test.records)
                title = test.quantity.title if test.quantity else "values"
                yield f"{test.name}, {title}: {names} are taken as repeats"
            yield from (f"  {line}" for line in test.disagreements)


def _words(signal: FileSignal) -> str:
    quantity = known_quantities().get(signal.quantity)
    title = quantity.title if quantity else signal.quantity.replace("_", " ")
    return f"{title} from '{signal.header}' [{signal.unit or 'no unit'}], {signal.y.size} points"


def look_at(files: Iterable[Path]) -> Looked:
    """Return measured files as they are understood.

    Parameters
    ----------
    files
        The files; a folder stands for the files in it.

    Raises
    ------
    DataError
        There is no such file, or none is given.
    """
    paths = [path for given in files for path in _files(given)]
    if not paths:
        raise DataError("there is no file to look at; name measured files or a folder of them")
    examined = [examine_file(path) for path in paths]
    run_checks(examined)
    return Looked(examined, list(_tests(examined)))


def _files(given: Path) -> list[Path]:
    if given.is_dir():
        from pyrofit_files.report import measured_files

        return sorted(measured_files(given))
    if not given.is_file():
        raise DataError(f"{given}: there is no such file; check the path")
    return [given]


def _tests(files: Iterable[Examined]) -> Iterator[Series]:
    groups: dict[tuple[str, str, str], list[tuple[str, FileSignal]]] = {}
    for seen in files:
        for name, signal in seen.signals.items():
            key = seen.kind, root_of(seen.path.stem), f"{name} {signal.scale}"
            groups.setdefault(key, []).append((seen.path.stem, signal))
    for (kind, root, _), records in groups.items():
        name = root if len(records) > 1 else records[0][0]
        yield Series(name, kind, known_quantities().get(records[0][1].quantity), tuple(records))


def abscissa_values(test: Series, signal: FileSignal) -> FloatArray:
    """Return the temperature [K] of a record against it, else its time [s]."""
    against = test.quantity is not None and test.quantity.against_temperature
    return signal.temperature_K if against and signal.temperature_K is not None else signal.x


def derivative(at: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return minus the derivative of a record, averaged over `POINTS` equal steps, and its places.

    -dy/dx = (y_k - y_(k+1)) / (x_(k+1) - x_k), in the middles of the steps.

    Parameters
    ----------
    at : abscissa, shape (n,); it counts where it is above all before.
    values : shape (n,).

    Examples
    --------
    >>> x = np.linspace(0.0, 10.0, 1001)
    >>> middle, rate = derivative(x, 5.0 - 2.0 * x)
    >>> bool(np.allclose(rate, 2.0))
    True
    """
    rising = np.concatenate([[True], at[1:] > np.maximum.accumulate(at)[:-1]])
    x, y = at[rising], values[rising]
    edges = np.linspace(x[0], x[-1], min(POINTS, x.size) + 1)
    ends = np.interp(edges, x, y)
    return 0.5 * (edges[1:] + edges[:-1]), -np.diff(ends) / np.diff(edges)
