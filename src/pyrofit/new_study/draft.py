"""What a study can say from measured files alone: experiments, and where to look for kinetics."""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import Table, read_table
from pyrofit.data.series import SeriesSpec, read_series
from pyrofit.errors import DataError, StudyError
from pyrofit.new_study.columns import Found, recognise

RATES_K_MIN = (0.5, 500.0)
FLUXES_KW_M2 = (5.0, 150.0)
_NUMBER = re.compile(r"(?<![\d.])(\d+(?:\.\d+)?)")
_WITH_UNIT = re.compile(r"(?<![\d.])(\d+(?:\.\d+)?)[ _-]?kW")


@dataclass(frozen=True, eq=False)
class Measured:
    """An experiment as far as its file tells.

    Parameters
    ----------
    name
        Name in the study, from that of the file.
    path
        The file; None where the measurement is to be computed.
    headers
        Its columns.
    signals
        What was recognised of each quantity.
    number
        Heating rate [K/min] or radiant flux [kW/m2].
    sure
        Whether the file tells that number.
    frames
        The series that can be read, in SI units, by quantity.
    """

    name: str
    path: Path | None
    headers: tuple[str, ...]
    signals: tuple[Found, ...]
    number: float
    sure: bool
    frames: dict[str, pd.DataFrame]


@dataclass(frozen=True)
class Kinetics:
    """Where to look for the kinetics: limits [K] of the reference temperature, residue [-]."""

    lower_K: float = 500.0
    upper_K: float = 750.0
    residue: float = 0.1


def tga(path: Path) -> Measured:
    """Read a TGA file as far as it goes.

    Raises
    ------
    DataError
        The file is no table of numbers.
    """
    table = read_table(path)
    found = recognise(table, "mass_fraction")
    frames = _frames(path, (found,))
    rate, sure = _first_number(path, RATES_K_MIN, 10.0)
    if "mass_fraction" in frames:
        rate, sure = _heating_rate(frames["mass_fraction"], rate), True
    return _measured(path, table, (found,), rate, sure, frames)


def gasification(path: Path) -> Measured:
    """Read a file of a gasification experiment as far as it goes.

    Raises
    ------
    DataError
        The file is no table of numbers.
    """
    table = read_table(path)
    signals = [recognise(table, quantity) for quantity in ("mlr", "back_temperature")]
    # What is not there at all is asked for only where the file has nothing else.
    there = tuple(found for found in signals if "value" in found.columns) or (signals[0],)
    named = _WITH_UNIT.search(path.stem)
    flux, sure = (float(named[1]), True) if named else _first_number(path, FLUXES_KW_M2, 50.0)
    return _measured(path, table, there, flux, sure, _frames(path, there))


def kinetics_of(records: Iterable[Measured]) -> Kinetics:
    """Return where to look for the kinetics, from the temperatures of half the loss of mass.

    At the usual heating rates the rate constant there is some 0.01 1/s; 0.001 1/s is reached 20 K
    to 120 K below.
    """
    half, rests = [], []
    for record in records:
        if (frame := record.frames.get("mass_fraction")) is None:
            continue
        mass, temperature = frame["mass_fraction"].to_numpy(), frame["temperature_K"].to_numpy()
        rest = float(np.median(mass[-5:]))
        below = np.flatnonzero(mass < 0.5 * (mass[0] + rest))
        if below.size and rest < 0.98:
            half.append(float(temperature[below[0]]))
            rests.append(rest)
    if not half:
        return Kinetics()
    residue = min(max(round(float(np.mean(rests)), 3), 0.001), 0.95)
    lower, upper = 5.0 * math.floor((min(half) - 150.0) / 5.0), 5.0 * math.ceil(max(half) / 5.0)
    return Kinetics(max(lower, 300.0), upper + 30.0, residue)


def check_names(records: Sequence[Measured]) -> None:
    """Refuse files that would give two experiments one name.

    Raises
    ------
    StudyError
        With both files.
    """
    first: dict[str, Path | None] = {}
    for record in records:
        if record.name in first:
            raise StudyError(
                f"{first[record.name]} and {record.path} would both be experiment "
                f"'{record.name}'; give the files different names"
            )
        first[record.name] = record.path


def _measured(
    path: Path,
    table: Table,
    signals: tuple[Found, ...],
    number: float,
    sure: bool,
    frames: dict[str, pd.DataFrame],
) -> Measured:
    name = re.sub(r"\W+", "_", path.stem, flags=re.ASCII).strip("_")
    if not name[:1].isalpha():
        name = f"run_{name}".rstrip("_")
    return Measured(name, path, tuple(table.columns), signals, number, sure, frames)


def _frames(path: Path, signals: Iterable[Found]) -> dict[str, pd.DataFrame]:
    """Return the series that can be read; what is wrong with others, `pyrofit check` tells."""
    frames = {}
    for found in signals:
        if not found.missing:
            spec = SeriesSpec(found.quantity, path, found.columns, found.units)
            try:
                frames[found.quantity] = read_series(spec).frame
            except DataError:
                continue
    return frames


def _first_number(path: Path, limits: tuple[float, float], usual: float) -> tuple[float, bool]:
    """Return the one number of a file's name that lies within limits, else a usual one."""
    numbers = [float(n) for n in _NUMBER.findall(path.stem)]
    fitting = [n for n in numbers if limits[0] <= n <= limits[1]]
    return (fitting[0], True) if len(fitting) == 1 else (usual, False)


def _heating_rate(frame: pd.DataFrame, named: float) -> float:
    """Return the heating rate [K/min]: the named one where the record agrees within 10 %."""
    rise = np.gradient(frame["temperature_K"].to_numpy(), frame["time_s"].to_numpy())
    rate = 60.0 * float(np.median(rise))
    return named if abs(rate - named) <= 0.1 * abs(named) else float(f"{rate:.3g}")
