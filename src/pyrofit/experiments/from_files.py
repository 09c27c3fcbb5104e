"""Entries of a kind of experiment in a new study that `pyrofit init` writes from files."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pandas as pd

Frames = Mapping[str, pd.DataFrame]
"""Series of one file in SI units, by quantity."""


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
    """

    unit: str
    limits: tuple[float, float]
    usual: float

    def find(self, name: str) -> tuple[float, bool]:
        """Return the number, and whether the name tells it.

        A number with its unit counts before one without; where several fit, none is taken.

        >>> flux = NamedNumber("kW", (5.0, 150.0), 50.0)
        >>> flux.find("Lab_Gasification_25kW_1"), flux.find("slab 60"), flux.find("a_20_b_30")
        ((25.0, True), (60.0, True), (50.0, False))
        >>> NamedNumber("K", (0.5, 500.0), 10.0).find("TGA_N2_2-5K_1")
        (2.5, True)
        """
        number = r"(?<![\d.])(\d+(?:\.\d+)?)"
        with_unit = rf"(?<![\d.])(\d+(?:[.-]\d+)?)[ _-]?(?:{self.unit})(?![A-Za-z])"
        named = {float(found.replace("-", ".")) for found in re.findall(with_unit, name)}
        if len(named) != 1:
            numbers = [float(found) for found in re.findall(number, name)]
            fitting = [n for n in numbers if self.limits[0] <= n <= self.limits[1]]
            named = set(fitting) if len(fitting) == 1 else set()
        return (named.pop(), True) if named else (self.usual, False)


@dataclass(frozen=True)
class Loss:
    """Point of a record at half of its loss.

    Parameters
    ----------
    temperature_K
        Temperature of half the loss [K].
    residue
        Residue [kg/kg]; None where the record does not tell it.
    """

    temperature_K: float
    residue: float | None


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
