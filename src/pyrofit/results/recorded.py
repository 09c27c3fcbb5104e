"""Measured series as they were read."""

from typing import Any, NamedTuple

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv, read_json
from pyrofit.results.needed import Keys

About = dict[str, dict[str, dict[str, Any]]]
"""Records of the read files, by experiment and signal: source, checksum, points, notes."""


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
    about: About = summary(study, results)["signals"]
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


def summary(study: Study, results: Results) -> dict[str, Any]:
    """Return the records of the read files, by experiment and signal."""
    needs: dict[Keys, type] = {}
    for name, experiment in study.experiments.items():
        for signal in experiment.signals:
            here = ("signals", name, signal)
            needs |= {(*here, "source"): str, (*here, "sha256"): str, (*here, "points"): float}
            if experiment.quantity(signal).released is not None:
                needs[*here, "released_kg_m2"] = float
            if experiment.quantity(signal).heat is not None:
                needs[*here, "released_J_m2"] = float
    return read_json(results.measurements_summary, needs)
