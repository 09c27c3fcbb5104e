"""Measured series as they were read."""

from collections.abc import Mapping
from typing import NamedTuple

import pandas as pd
from pydantic import Field

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.files import Results, read_csv, write_json
from pyrofit.results.needed import AGAIN
from pyrofit.results.record import Record, check_names, read_record


class OfFile(Record):
    """Where a series comes from, and notes on it; computed ones have no checksum."""

    source: str
    sha256: str
    uncertainty: str = ""
    notes: list[str] = Field(default_factory=list)


class OfSeries(OfFile):
    """A series as it was read, with the mass and the heat that it released."""

    points: int
    released_kg_m2: float | None = None
    released_J_m2: float | None = None


About = Mapping[str, Mapping[str, OfSeries]]
"""Records of the series, by experiment and signal."""


class Summary(Record):
    """The content of ``measurements/summary.json``."""

    signals: dict[str, dict[str, OfSeries]]


class Measured(NamedTuple):
    """All series of a study, and the record of each."""

    about: About
    series: dict[tuple[str, str], pd.DataFrame]
    """By experiment and signal, SI units."""


def measured(study: Study, results: Results) -> Measured:
    """Return all series as they were read.

    Raises
    ------
    DataError
        The measurements have not been read.
    """
    about = read_summary(study, results)
    keys = [(name, signal) for name, signals in about.items() for signal in signals]
    return Measured(about, {(n, s): series(study, results, n, s) for n, s in keys})


def series(study: Study, results: Results, experiment: str, signal: str) -> pd.DataFrame:
    """Return a measured series in SI units."""
    quantity = study.experiments[experiment].quantity(signal)
    columns = {"time_s": float, quantity.column: float}
    if quantity.against_temperature:
        columns["temperature_K"] = float
    return read_csv(results.measurement(experiment, signal), columns)


def load(study: Study, results: Results) -> dict[tuple[str, str], pd.DataFrame]:
    """Return the series as they were read, by (experiment, signal), without their records."""
    return {
        (name, signal): series(study, results, name, signal)
        for name, experiment in study.experiments.items()
        for signal in experiment.signals
    }


def read_summary(study: Study, results: Results) -> About:
    """Return the records of the series, by experiment and signal.

    Raises
    ------
    DataError
        The file is missing or broken, or lacks a series of the study.
    """
    path = results.measurements_summary
    found = read_record(path, Summary).signals
    check_names(path, "signals", found, study.experiments)
    for name, experiment in study.experiments.items():
        check_names(path, f"signals.{name}", found[name], experiment.signals)
        for signal in experiment.signals:
            quantity, about = experiment.quantity(signal), found[name][signal]
            for asked, total in (
                (quantity.released, about.released_kg_m2),
                (quantity.heat, about.released_J_m2),
            ):
                if asked is not None and total is None:
                    place = f"signals.{name}.{signal}"
                    raise DataError(f"{path}: '{place}' has no released mass or heat; {AGAIN}")
    return found


def write_summary(results: Results, about: About) -> None:
    """Write the records of the series, each with the keys that it has."""
    content = Summary(signals={name: dict(signals) for name, signals in about.items()})
    write_json(results.measurements_summary, content.model_dump(exclude_unset=True))
