"""The measured series, their use, range and uncertainty, and the mass closure."""

from collections.abc import Callable, Mapping
from typing import Any

import pandas as pd

from pyrofit.analysis.closure import closure_lines
from pyrofit.analysis.uses import FITTED, HELD_OUT, title_of, use_of
from pyrofit.config import Study, calibration_channels, held_out_channels
from pyrofit.model.signal import Signal
from pyrofit.quantities.base import Quantity
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.results.kinetics import heats_shown, masses_shown
from pyrofit.results.recorded import About, Measured
from pyrofit.show.names import signal_words
from pyrofit.show.units import difference, difference_unit, shown

KINETICS, NOT_USED = "kinetics, fitted", "not used"
Use = Callable[[Study, str, str], str]
"""Returns the use of a series in words, given a study, an experiment and a signal."""


def rows_of_series(study: Study, measured: Measured, use: Use) -> list[dict[str, Any]]:
    """Return a row for each measured series."""
    rows = []
    for name, signals in measured.about.items():
        for signal, about in signals.items():
            frame = measured.series[name, signal]
            rows.append(
                {
                    "experiment": title_of(study, name),
                    "signal": signal_words(study, name, signal),
                    "use": use(study, name, signal),
                    "points": about.points,
                    "over": _over(frame),
                    "values": _values(frame, study.experiments[name].quantity(signal)),
                    "uncertainty": _size(frame, study.experiments[name].quantity(signal)),
                }
            )
    return rows


def notes(study: Study, about: About) -> list[tuple[str, str]]:
    """Return the notes on series: each note once, and the series that have it."""
    found: dict[str, list[str]] = {}
    for name, signals in about.items():
        for signal, read in signals.items():
            stated = read.uncertainty or _noise(study, name, signal)
            said = [f"uncertainty: {stated}"] if stated else []
            for note in [*said, *read.notes]:
                words = f"{title_of(study, name)}, {signal_words(study, name, signal)}"
                found.setdefault(note, []).append(words)
    count = sum(len(signals) for signals in about.values())
    return [
        (note, "; ".join(names) if len(names) < count else "all series")
        for note, names in found.items()
    ]


def closure(study: Study, about: About) -> list[str]:
    """Return sentences on the released mass, with titles in place of the experiments' names."""
    lines = []
    for line in closure_lines(study, about):
        head, colon, rest = line.partition(": ")
        names = [title_of(study, n) if n in study.experiments else n for n in head.split(" and ")]
        lines.append(" and ".join(names) + colon + rest)
    return lines


def use_in_campaign(study: Study, name: str, signal: str) -> str:
    """Return the use of a series in kinetics, inverse modelling and validation."""
    if _fits_kinetics(study, name, signal):
        return KINETICS
    if name in masses_shown(study) or (name, signal) in heats_shown(study):
        return "kinetics, compared"
    uses = [use_of(study, cost, name, signal) for cost in study.imp.costs]
    if FITTED in uses:
        return FITTED
    if name not in study.validation.experiments:
        return NOT_USED
    return uses[0] if len(set(uses)) == 1 else HELD_OUT


def use_in_diagnosis(study: Study, name: str, signal: str) -> str:
    """Return the use of a series in the diagnosis, or in the kinetics that it starts from."""
    if any((c.experiment, c.signal) == (name, signal) for c in calibration_channels(study)):
        return FITTED
    if any((c.experiment, c.signal) == (name, signal) for c in held_out_channels(study)):
        return HELD_OUT
    return KINETICS if _fits_kinetics(study, name, signal) else NOT_USED


def _fits_kinetics(study: Study, name: str, signal: str) -> bool:
    cost = study.kinetics.cost if study.kinetics else ()
    return any((t.experiment, t.signal) == (name, signal) and t.weight > 0.0 for t in cost)


def _over(frame: pd.DataFrame) -> str:
    if "temperature_K" in frame:
        low, high = (t - ICE_POINT_K for t in _ends(frame["temperature_K"]))
        return f"{low:.0f} to {high:.0f} °C"
    low, high = _ends(frame["time_s"])
    return f"{low:.0f} to {high:.0f} s"


def _values(frame: pd.DataFrame, quantity: Quantity) -> str:
    low, high = shown(quantity, _ends(frame[quantity.column]))
    return f"{low:.3g} to {high:.3g} {_unit(quantity.shown.unit)}".strip()


def _unit(unit: str) -> str:
    return unit.replace("–", "")


def _ends(values: pd.Series) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _size(frame: pd.DataFrame, quantity: Quantity) -> str:
    """Return the median of the stated uncertainty."""
    column = quantity.uncertainty_column
    if column not in frame:
        return "not stated"
    size = float(difference(quantity, frame[column].median()))
    return f"± {size:.2g} {_unit(difference_unit(quantity))}".strip()


def _noise(study: Study, experiment: str, signal: str) -> str:
    signals: Mapping[str, Signal] = study.experiments[experiment].signals
    return "standard deviation of the noise" if signals[signal].noise.sd > 0.0 else ""
