"""Entries of a kind of experiment in a new study that `pyrofit init` writes from files."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import pandas as pd

from pyrofit.solver.arrays import FloatArray

Frames = Mapping[str, pd.DataFrame]
"""Series of one file in SI units, by quantity."""
Told = Literal["record", "file", "unit", "number", ""]
"""What tells the number of an experiment: its record, a line of its file, a number in the name.

A number with its unit in the name of the file is a hint, and one alone a weak hint: the user is
asked to look."""


@dataclass(frozen=True)
class NamedNumber:
    """The number of an experiment that the name of its file may tell.

    Parameters
    ----------
    unit
        Regular expression of the text after the number.
    limits
        A number without unit counts where it lies within these.
    usual
        The number where neither name nor record tells it.
    words, shown
        What the number is, and its unit, in texts.
    symbol
        Regular expression of the text before the number that counts as its unit does.
    """

    unit: str
    limits: tuple[float, float]
    usual: float
    words: str = ""
    shown: str = ""
    symbol: str = "(?!)"

    def find(self, name: str) -> tuple[float, Told]:
        """Return the number to which the name hints, and how it does.

        A number with its unit counts before one without; where several fit, none is taken. A
        number that letters touch, as in NH4Cl, 6mm or batch3, is part of a word. As names of files
        often have no point, a comma, a hyphen or the letter p stands for it before a unit.

        >>> flux = NamedNumber("kW", (5.0, 150.0), 50.0)
        >>> flux.find("Lab_Gasification_25kW_1"), flux.find("slab 60"), flux.find("a_20_b_30")
        ((25.0, 'unit'), (60.0, 'number'), (50.0, ''))
        >>> rate = NamedNumber("K", (0.5, 500.0), 10.0)
        >>> rate.find("TGA_N2_2-5K_1"), rate.find("NH4Cl_batch3"), rate.find("TGA_563Kiso")
        ((2.5, 'unit'), (10.0, ''), (10.0, ''))
        >>> rate.find("foam_2p5K"), rate.find("foam_2,5K")
        ((2.5, 'unit'), (2.5, 'unit'))
        >>> NamedNumber("K", (0.5, 500.0), 10.0, symbol="beta").find("foam_beta20")
        (20.0, 'unit')
        """
        number = r"(?<![A-Za-z\d.])(\d+(?:\.\d+)?)(?![A-Za-z\d])"
        with_unit = rf"(?<![\d.])(\d+(?:[.,p-]\d+)?)[ _-]?(?:{self.unit})(?![A-Za-z])"
        behind = rf"(?<![A-Za-z])(?:{self.symbol})[ _=-]?(\d+(?:[.,p]\d+)?)(?![A-Za-z\d])"
        found = [*re.findall(with_unit, name), *re.findall(behind, name, re.I)]
        units = {float(re.sub("[,p-]", ".", text)) for text in found}
        alone = [float(found) for found in re.findall(number, name)]
        if len(named := self._fitting(units)) == 1:
            return named[0], "unit"
        if len(named := self._fitting(alone)) == 1 and not units:
            return named[0], "number"
        return self.usual, ""

    def _fitting(self, numbers: Iterable[float]) -> list[float]:
        return [n for n in numbers if self.limits[0] <= n <= self.limits[1]]


@dataclass(frozen=True)
class Loss:
    """Loss of mass of a record.

    Parameters
    ----------
    temperature_K
        Temperature of half the loss [K].
    residue
        Residue [kg/kg]; None where the record does not tell it.
    moisture
        Loss before 420 K over the initial mass [kg/kg]; 0 where the reaction begins there.
    parts_K
        Temperatures [K] of an eighth, half and seven eighths of the loss without the moisture.
    record
        Times [s], temperatures [K] and masses, shape (n,) each.
    held
        Whether its temperature is held.
    end
        Mass at the end over the initial one, above which the residue is not.
    """

    temperature_K: float
    residue: float | None
    moisture: float = 0.0
    parts_K: tuple[float, float, float] | None = None
    record: tuple[FloatArray, FloatArray, FloatArray] | None = None
    held: bool = False
    end: float = 1.0


@dataclass(frozen=True)
class FromFiles:
    """Entries of a new study for a kind of experiment.

    Its lines of the study file are the template ``new.yaml.j2`` in the folder of the kind.

    Parameters
    ----------
    help
        Help of its option, which has the name of the kind.
    number
        The number that the name of a file may tell: a heating rate, a flux.
    recorded
        That number as the record shows it, where it does; the first argument is the named one.
    facts
        Other facts of the record that the template needs, by name.
    loss
        Where the record shows the reaction, if it does.
    computed
        Numbers of the experiments that are computed where no file is given.
    computed_signal
        The signal that is computed then.
    """

    help: str
    number: NamedNumber
    recorded: Callable[[float, Frames], float | None]
    facts: Callable[[Frames], Mapping[str, Any]]
    loss: Callable[[Frames], Loss | None]
    computed: tuple[float, ...] = ()
    computed_signal: str = ""
