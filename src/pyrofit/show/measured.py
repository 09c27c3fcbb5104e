"""The measured series, their use, range and uncertainty, and the mass closure."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.analysis.closure import closure_lines
from pyrofit.analysis.uses import FITTED, HELD_OUT, all_rates, rates_in_fit, title_of, use_of
from pyrofit.config import Study
from pyrofit.model.signal import Signal
from pyrofit.quantities import known_quantities
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.results import recorded
from pyrofit.results.files import Results

_SHOWN = {
    "mlr": ("mass loss rate", 1e3, 0.0, "g/(m² s)"),
    "back_temperature": ("back temperature", 1.0, -ICE_POINT_K, "°C"),
    "mass_fraction": ("mass fraction", 1.0, 0.0, ""),
}
"""Name, factor, shift and unit that a signal is shown with."""


def series(study: Study, results: Results, measured: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return a row for each measured series."""
    rows = []
    for name, signals in measured["signals"].items():
        for signal, about in signals.items():
            frame = recorded.series(study, results, name, signal)
            rows.append(
                {
                    "experiment": title_of(study, name),
                    "signal": _SHOWN[signal][0],
                    "use": _use(study, name, signal),
                    "points": about["points"],
                    "over": _over(frame),
                    "values": _values(frame, signal),
                    "uncertainty": _size(frame, signal),
                }
            )
    return rows


def notes(study: Study, measured: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return what is to be known of series: each note once, and the series that have it."""
    found: dict[str, list[str]] = {}
    for name, signals in measured["signals"].items():
        for signal, about in signals.items():
            stated = about.get("uncertainty") or _noise(study, name, signal)
            said = [f"uncertainty: {stated}"] if stated else []
            for note in [*said, *about.get("notes", [])]:
                found.setdefault(note, []).append(f"{title_of(study, name)}, {_SHOWN[signal][0]}")
    count = sum(len(signals) for signals in measured["signals"].values())
    return [
        (note, "; ".join(names) if len(names) < count else "all series")
        for note, names in found.items()
    ]


def closure(study: Study, measured: Mapping[str, Any]) -> list[str]:
    """Return sentences on the released mass, with titles in place of the experiments' names."""
    lines = []
    for line in closure_lines(study, measured["signals"]):
        head, colon, rest = line.partition(": ")
        names = [title_of(study, n) if n in study.experiments else n for n in head.split(" and ")]
        lines.append(" and ".join(names) + colon + rest)
    return lines


def _use(study: Study, name: str, signal: str) -> str:
    """Say what a series is for."""
    if name in rates_in_fit(study):
        return "kinetics, fitted"
    if name in all_rates(study):
        return "kinetics, compared"
    uses = [use_of(study, cost, name, signal) for cost in study.imp.costs]
    if FITTED in uses:
        return FITTED
    if name not in study.validation.experiments:
        return "not used"
    return uses[0] if len(set(uses)) == 1 else HELD_OUT


def _over(frame: pd.DataFrame) -> str:
    if "temperature_K" in frame:
        low, high = (t - ICE_POINT_K for t in _ends(frame["temperature_K"]))
        return f"{low:.0f} to {high:.0f} °C"
    low, high = _ends(frame["time_s"])
    return f"{low:.0f} to {high:.0f} s"


def _values(frame: pd.DataFrame, signal: str) -> str:
    _, factor, shift, unit = _SHOWN[signal]
    low, high = (factor * v + shift for v in _ends(frame[known_quantities()[signal].column]))
    return f"{low:.3g} to {high:.3g} {unit}".strip()


def _ends(values: pd.Series) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def _size(frame: pd.DataFrame, signal: str) -> str:
    """Return the median of the stated uncertainty."""
    column = known_quantities()[signal].uncertainty_column
    if column not in frame:
        return "not stated"
    _, factor, _, unit = _SHOWN[signal]
    unit = "K" if unit == "°C" else unit
    return f"± {factor * float(frame[column].median()):.2g} {unit}".strip()


def _noise(study: Study, experiment: str, signal: str) -> str:
    signals: Mapping[str, Signal] = study.experiments[experiment].signals
    return "standard deviation of the noise" if signals[signal].noise.sd > 0.0 else ""
