"""Content of a study from measured files alone: experiments, and where to look for kinetics."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import FileTable, read_table
from pyrofit.data.gas_steps import holds_oxygen
from pyrofit.data.heating import EndOfHeating, end_of_heating
from pyrofit.errors import StudyError
from pyrofit.experiments import KINDS, files_of
from pyrofit.experiments.base import Kind
from pyrofit.experiments.from_files import Told
from pyrofit.experiments.heated.from_files import CHAR
from pyrofit.new_study.columns import FoundColumn, recognise
from pyrofit.new_study.frames import START_K, StatedCourse, frames_of, lacking
from pyrofit.new_study.gases import gas_of, gas_of_columns, then_gas
from pyrofit.new_study.one_reaction import one_reaction_describes
from pyrofit.quantities import known_quantities
from pyrofit.quantities.units import ICE_POINT_K

MOIST = 0.01
"""Loss of mass up to 420 K above which a sample is moist."""
NEAR_K = 5.0
"""Distance [K] from the temperature of a hold within which a number in a name means that."""
_OFF_ZERO = 0.02
"""Error of the zero of a balance over the initial mass."""
_PARTS = (-120.0, 20.0), (-100.0, 20.0), (-220.0, 120.0)
"""Limits [K] of reference temperatures about those of an eighth, half, seven eighths of the loss.

The rate constant is 0.001 1/s some 20 to 80 K below the peak of a reaction at usual rates.
"""


@dataclass(frozen=True, eq=False)
class MeasuredFile:
    """An experiment as far as its file tells.

    Parameters
    ----------
    kind
        Kind of experiment.
    name
        Name in the study, from that of the file.
    path
        The file; None where the measurement is to be computed.
    number
        Heating rate [K/min] or radiant flux [kW/m2].
    told
        What tells that number.
    hinted
        The number that the name of the file hints to; None where it hints to none.
    headers
        Its columns.
    signals
        The quantities that were found in it.
    left
        Why a column is not used, by header.
    frames
        The series that can be read, in SI units, by quantity.
    repeats
        Its repeats, where it stands for several.
    mended
        How its file was read, where that is not as a table in UTF-8 with decimal points.
    lacks
        "time" if its file has temperatures without times, "temperature" in the reverse case.
    end
        The end of the heating of a sample; the study leaves out what follows.
    then_gas
        A gas with oxygen to which the gas is changed at a time that the file does not tell.
    gas
        The gas around the sample, as the file or its name tells it.
    """

    kind: str
    name: str
    path: Path | None
    number: float
    told: Told = "record"
    hinted: float | None = None
    headers: tuple[str, ...] = ()
    signals: tuple[FoundColumn, ...] = ()
    left: Mapping[str, str] = field(default_factory=dict)
    frames: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    repeats: tuple["MeasuredFile", ...] = ()
    mended: tuple[str, ...] = ()
    lacks: str = ""
    end: EndOfHeating | None = None
    then_gas: str = ""
    gas: str = ""

    @property
    def in_oxygen(self) -> bool:
        """Whether the sample is heated in a gas with oxygen, of which the model knows nothing."""
        return self.of.stage == "kinetics" and holds_oxygen(self.gas)

    @property
    def of(self) -> Kind:
        """Its kind of experiment."""
        return KINDS[self.kind]


@dataclass(frozen=True)
class KineticsDraft:
    """Where to look for the kinetics: limits [K] of the reference temperature, residue [-].

    ``moisture`` is the loss by drying [-], ``parts_K`` are limits of three parallel reactions. If
    the mass still falls at the end of all records, ``least_end`` is the least at an end [-], which
    the residue does not exceed.
    """

    lower_K: float = 500.0
    upper_K: float = 750.0
    residue: float = 0.1
    known_residue: bool = False
    least_end: float | None = None
    moisture: float = 0.0
    parts_K: tuple[tuple[float, float], ...] = ()
    single: bool = False
    """Whether one reaction of first order describes the records."""

    @property
    def tells_residue(self) -> bool:
        """Whether records tell the residue, or the most that it can be."""
        return self.known_residue or self.least_end is not None

    @property
    def charring(self) -> bool:
        """Whether so much is left that char has properties of its own.

        Half as much is char as well if the solid holds water and one reaction does not describe it.
        """
        least = 0.5 * CHAR if self.moist and not self.single else CHAR
        return self.known_residue and self.residue > least

    @property
    def parts(self) -> list[tuple[str, str, tuple[int, int], tuple[float, float]]]:
        """Reactions of a charring solid: letter, name, limits of E [kJ/mol], and of T [K]."""
        if self.single:
            return [("p", "pyrolysis", (60, 350), (self.lower_K, self.upper_K))]
        names = [("e", "early", (50, 250)), ("m", "main", (80, 350)), ("l", "late", (30, 250))]
        return [(*name, limits) for name, limits in zip(names, self.parts_K, strict=True)]

    @property
    def moist(self) -> bool:
        """Whether records show drying."""
        return self.moisture > MOIST

    @property
    def asks_water(self) -> bool:
        """Whether slabs may hold water w_w that the records do not show."""
        return self.charring and not self.moist

    @property
    def moistures(self) -> tuple[float, float]:
        """Limits of the mass fraction of water: half to one and a half times the loss.

        Above 0.12 the upper one is 1.2 times the loss, at most 0.95.
        """
        upper = min(1.5 * self.moisture, max(0.12, 1.2 * self.moisture))
        return round(0.5 * self.moisture, 3), min(round(upper, 3), 0.95)

    @property
    def shares(self) -> list[tuple[str, tuple[float, float]]]:
        """Limits of the mass fractions of the early and late component, by name.

        With the water the upper ones add up to one at most.
        """
        dry = min((1.0 - self.moistures[1]) / 0.88, 1.0) if self.moist else 1.0
        upper = {"early": math.floor(460.0 * dry) / 1e3, "late": math.floor(420.0 * dry) / 1e3}
        return [(name, (min(0.05, 0.5 * most), most)) for name, most in upper.items()]

    @property
    def yields(self) -> tuple[float, float]:
        """Limits of the char yield of the dry material."""
        dry = 1.0 - (self.moisture if self.moist else 0.0)
        lower, upper = self.residues
        return round(lower / dry, 3), min(round(upper / dry, 3), 0.99)

    @property
    def residues(self) -> tuple[float, float]:
        """Limits of the residue: the end of a record shows it but for noise, or it is below."""
        if self.least_end is not None:
            return 0.0, round(self.least_end, 3)
        return max(round(self.residue - 0.05, 3), 0.0), min(round(self.residue + 0.05, 3), 0.99)


def _is_set_point(number: float, facts: Mapping[str, Any]) -> bool:
    """Tell whether a number is the temperature that a record holds, in K or degrees Celsius."""
    held = facts.get("set_point_K")
    return held is not None and min(abs(number - held), abs(number + ICE_POINT_K - held)) < NEAR_K


def read_experiment(kind: str, path: Path) -> MeasuredFile:
    """Read a file of a kind of experiment as far as it goes.

    Raises
    ------
    DataError
        The file is no table of numbers.
    """
    table = read_table(path)
    recognised = recognise(table, kind)
    files = files_of(kind)
    number, told = files.number.find(path.stem)
    hinted = number if told else None
    signals = recognised.signals
    lacks, course = lacking(recognised), StatedCourse()
    if lacks:
        signals = tuple(replace(found, missing=()) for found in signals)
        course = StatedCourse(number / 60.0, START_K if lacks == "temperature" else None)
    frames, thinned = frames_of(table, signals, course)
    end = _end_of_heating(frames, table)
    if end is not None:
        frames = {name: frame[frame["time_s"] <= end.time_s] for name, frame in frames.items()}
    if _is_set_point(number, files.facts(frames)):
        number, told, hinted = files.number.usual, "", None
    recorded = files.recorded(number, frames)
    if recorded is not None and not lacks:
        number, told = recorded, "record"
    if table.stated.flux_kW_m2 is not None and KINDS[kind].stage == "imp":
        number, told = table.stated.flux_kW_m2, "file"
    name = re.sub(r"\W+", "_", path.stem, flags=re.ASCII).strip("_")
    if not name[:1].isalpha():
        name = f"run_{name}".rstrip("_")
    headers = tuple(table.columns)
    return MeasuredFile(
        kind,
        name,
        path,
        number,
        told,
        hinted,
        headers,
        signals,
        recognised.left,
        frames,
        mended=(*table.mended, *thinned),
        lacks=lacks,
        end=end,
        then_gas=(table.stated.then_gas or then_gas(kind, table)) if end is None else "",
        gas=table.stated.gas or gas_of(path.stem) or gas_of_columns(kind, table),
    )


def _end_of_heating(frames: Mapping[str, pd.DataFrame], table: FileTable) -> EndOfHeating | None:
    """Return the end of the heating of a sample; None where the whole record is one."""
    ends = (
        end_of_heating(frame, known_quantities()[name], table.stated)
        for name, frame in frames.items()
        if known_quantities()[name].against_temperature
    )
    return min((end for end in ends if end is not None), default=None)


def kinetics_limits(records: Iterable[MeasuredFile]) -> KineticsDraft:
    """Return where to look for the kinetics, from the temperatures of half the loss of mass.

    At the usual heating rates the rate constant there is some 0.01 1/s; 0.001 1/s is reached 20 K
    to 120 K below.
    """
    losses = [loss for run in records if (loss := files_of(run.kind).loss(run.frames)) is not None]
    if not losses:
        return KineticsDraft()
    masses = [loss.record for loss in losses if loss.record is not None]
    half = [loss.temperature_K for loss in losses]
    lower, upper = 5.0 * math.floor((min(half) - 150.0) / 5.0), 5.0 * math.ceil(max(half) / 5.0)
    known = [loss for loss in losses if loss.residue is not None]
    # A temperature that is held may be too low for the last reaction.
    ramps = [loss for loss in known if not loss.held] or known
    rests = [loss.residue for loss in ramps if loss.residue is not None]
    residue = float(np.mean(rests)) if rests else KineticsDraft.residue
    return KineticsDraft(
        max(lower, 300.0),
        upper + 30.0,
        min(max(round(residue, 4), 0.001), 0.95),
        bool(rests),
        None if rests else max(min(loss.end for loss in losses) + _OFF_ZERO, 0.05),
        float(np.median([loss.moisture for loss in losses])),
        _parts([loss.parts_K for loss in losses if loss.parts_K is not None]),
        one_reaction_describes(masses, float(np.median(half))),
    )


def _parts(records: Sequence[tuple[float, ...]]) -> tuple[tuple[float, float], ...]:
    """Return limits [K] of the reference temperatures of parallel reactions, early to late."""
    return tuple(
        (
            max(5.0 * math.floor((min(found) + below) / 5.0), 300.0),
            5.0 * math.ceil((max(found) + above) / 5.0),
        )
        for found, (below, above) in zip(zip(*records, strict=True), _PARTS, strict=True)
    )


def check_names_of_files(records: Sequence[MeasuredFile]) -> None:
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
