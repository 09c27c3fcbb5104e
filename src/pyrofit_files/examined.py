"""A measured file, its identification, and its signals in SI units."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pyrofit.data.csvfile import FileTable
from pyrofit_files.names import Label
from pyrofit_files.readme import StatedFacts

FloatArray = NDArray[np.float64]
Weight = Literal["fault", "doubt", "note"]


@dataclass(frozen=True)
class FileFinding:
    """A fault of a file, or an apparent one.

    Parameters
    ----------
    check
        Name of the check.
    weight
        `fault`: wrong by itself. `doubt`: unusual, to be looked at. `note`: was read all the same.
    text
        The finding, with numbers.
    column
        Header of the column; nothing where the file as a whole is meant.
    """

    check: str
    weight: Weight
    text: str
    column: str = ""


@dataclass(frozen=True, eq=False)
class FileSignal:
    """A column of a file in SI units.

    Parameters
    ----------
    quantity
        Name of the quantity.
    header, unit
        Header, and the unit as the file states it; nothing where it states none.
    scale
        Kind of unit, see `pyrofit.quantities.units`.
    x : time [s], temperature [K] or wavenumber [1/m] of each value, shape (n,)
    y : values, shape (n,)
    temperature_K : temperature of a heated sample, shape (n,)
    """

    quantity: str
    header: str
    unit: str
    scale: str
    x: FloatArray
    y: FloatArray
    temperature_K: FloatArray | None = None


@dataclass(eq=False)
class Examined:
    """A measured file and the results of its examination.

    Parameters
    ----------
    path
        The file.
    label
        The parts of its name.
    facts
        The facts that the README states of it.
    table
        Its columns; None where it cannot be read.
    signals
        Columns that are recognised, by name of the signal.
    left
        Why other columns are not, by header.
    findings
        Its faults, doubts and notes.
    """

    path: Path
    label: Label
    facts: StatedFacts
    kind: str = ""
    table: FileTable | None = None
    signals: dict[str, FileSignal] = field(default_factory=dict)
    left: Mapping[str, str] = field(default_factory=dict)
    findings: list[FileFinding] = field(default_factory=list)

    @property
    def classified(self) -> bool:
        """Whether the kind of the file is known, and at least one of its signals can be read."""
        return bool(self.kind and self.signals)

    @property
    def signals_in_words(self) -> str:
        """Its signals with the units of their columns."""
        found = self.signals.items()
        return ", ".join(f"{name.replace('_', ' ')} [{of.unit or '-'}]" for name, of in found)

    def say(self, check: str, weight: Weight, text: str, column: str = "") -> None:
        """Add a finding."""
        self.findings.append(FileFinding(check, weight, text, column))
