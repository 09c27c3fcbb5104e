"""Changes of a case that undo an error of a description or a file."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.effects.base import changed
from pyrofit.steps.preview.reach import NOISE, Channel, RecordedCases

USUAL_C, ENDS = 1500.0, 0.1
"""Specific heat [J/(kg K)] that a heat flow shows at its ends, each a tenth of the points."""

Change = Callable[[RecordedCases], RecordedCases]


def multiplied(factor: float) -> Callable[[Any], Any]:
    """Return the product with a factor, as a function."""
    return lambda values: factor * values


def part_changed(
    name: str, place: str, key: str, factor: float | None, value: float | None = None
) -> Change:
    """Return the change of one number of a part of the description."""

    def change(case: RecordedCases) -> RecordedCases:
        experiment: Any = case.experiments[name]
        part = getattr(experiment, place)
        old = getattr(part, key)
        new: Any = value
        if factor is not None:
            new = f"{factor!r} * ({old})" if isinstance(old, str) else factor * old
        made = changed(experiment, **{place: changed(part, **{key: new})})
        return case.with_experiment(name, made)

    return change


def column_changed(
    name: str,
    signals: Sequence[str],
    column: str,
    change: Callable[[Any], Any],
) -> Change:
    """Return the change of a column of records: the one named, else that of the values."""

    def apply(case: RecordedCases) -> RecordedCases:
        for signal in signals:
            own = column or case.experiments[name].quantity(signal).column
            frame = case.frames[name, signal]
            old = frame[own].to_numpy(float)
            made = frame.assign(**{own: change(old)})
            if not column or own == case.experiments[name].quantity(signal).column:
                made[NOISE] = frame[NOISE] * np.ptp(made[own]) / max(np.ptp(old), 1e-300)
            case = case.with_frame((name, signal), made)
        return case

    return apply


def shifted(name: str, signals: Sequence[str], shift: float) -> Change:
    """Return the shift of records in time; points before the start of the test are left out."""

    def apply(case: RecordedCases) -> RecordedCases:
        for signal in signals:
            frame = case.frames[name, signal]
            frame = frame.assign(time_s=frame["time_s"] + shift)
            kept = frame[frame["time_s"] >= 0.0].reset_index(drop=True)
            if len(kept) > 2:
                case = case.with_frame((name, signal), kept)
        return case

    return apply


def heated_at(name: str, signals: Sequence[str], rate: float, factor: float) -> Change:
    """Return the change of a heating rate, and of the times that rest on it."""

    def apply(case: RecordedCases) -> RecordedCases:
        experiment = case.experiments[name]
        for signal in signals:
            frame = case.frames[name, signal]
            case = case.with_frame((name, signal), frame.assign(time_s=frame["time_s"] / factor))
        return case.with_experiment(name, changed(experiment, heating_rate_K_min=rate))

    return apply


def without_baselines(of: Sequence[Channel]) -> Change:
    """Return heat flows less a line, so that their ends are those of a usual specific heat."""

    def apply(case: RecordedCases) -> RecordedCases:
        for channel in of:
            name, signal = channel
            frame, column = case.frames[channel], case.experiments[name].quantity(signal).column
            T, values = frame["temperature_K"].to_numpy(float), frame[column].to_numpy(float)
            rate = np.ptp(T) / np.ptp(frame["time_s"])
            count = max(int(ENDS * T.size), 1)
            ends = slice(None, count), slice(-count, None)
            at = [float(np.median(T[end])) for end in ends]
            off = [
                float(np.median(values[end])) - USUAL_C * rate * share
                for end, share in zip(ends, (1.0, _left(case, name)), strict=True)
            ]
            line = off[0] + (T - at[0]) * (off[1] - off[0]) / (at[1] - at[0])
            case = case.with_frame(channel, frame.assign(**{column: values - line}))
        return case

    return apply


def before_backing(of: Sequence[Channel]) -> Change:
    """Return back temperatures as those between the layers of a sample and its backing."""

    def apply(case: RecordedCases) -> RecordedCases:
        for name, signal in of:
            slab: Any = case.experiments[name]
            layer = len(slab.sample.layers)
            named = slab.quantity(signal).before_backing
            moved = changed(slab.signals[signal], quantity=named, layer=layer)
            new = changed(slab, signals={**slab.signals, signal: moved})
            columns = {slab.quantity(signal).column: new.quantity(signal).column}
            frame = case.frames[name, signal].rename(columns=columns)
            case = case.with_experiment(name, new).with_frame((name, signal), frame)
        return case

    return apply


def _left(case: RecordedCases, name: str) -> float:
    """Return the mass at the end of a test over the initial one, 0 where it is not recorded."""
    for signal in case.signals(name):
        quantity = case.experiments[name].quantity(signal)
        if quantity.scales[0] == "fraction":
            return float(case.frames[name, signal][quantity.column].iloc[-1])
    return 0.0


def swapped(one: str, other: str, signals: Sequence[str]) -> Change:
    """Return the exchange of the records of two experiments."""

    def apply(case: RecordedCases) -> RecordedCases:
        frames: dict[Channel, pd.DataFrame] = dict(case.frames)
        for signal in signals:
            frames[one, signal], frames[other, signal] = (
                case.frames[other, signal],
                case.frames[one, signal],
            )
        return RecordedCases(case.experiments, frames)

    return apply
