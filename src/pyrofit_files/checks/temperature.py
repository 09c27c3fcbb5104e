"""Temperatures: unit, heating rate, and where they were measured."""

import numpy as np

from pyrofit.data.suspect import FEWEST_POINTS, FRONT_K, early_rise_K
from pyrofit.numerics import fitting
from pyrofit_files.examined import Examined, FloatArray, Weight
from pyrofit_files.signals import is_back, is_slab, temperatures

_ROOM_K = (270.0, 320.0)
_POSSIBLE_K = (180.0, 1600.0)
_RAMP_K = (400.0, 750.0)
"""Where the heating rate is taken [K]."""
_OFF = 0.15
"""Deviation of a heating rate from that of the name that is unusual; twice is a fault."""
_CYCLE_K = 20.0
"""Fall of the temperature that shows a cycle [K]."""


def check_heating_rate(seen: Examined) -> None:
    """Compare the heating rate of the record with that of the name."""
    wanted, T = seen.label.heating_K_min, _heated(seen)
    if wanted is None or T is None:
        return
    falls = float((np.maximum.accumulate(T[1]) - T[1]).max())
    if falls > _CYCLE_K:
        text = f"no single ramp: the temperature falls by {falls:.0f} K within the record"
        seen.say("heating rate", "doubt", text)
        return
    ramp = (T[1] > _RAMP_K[0]) & (T[1] < _RAMP_K[1])
    if ramp.sum() < 5:
        span = f"{T[1].min():.0f} to {T[1].max():.0f} K"
        seen.say("heating rate", "doubt", f"no ramp through the decomposition: {span}")
        return
    rate = 60.0 * float(fitting.polynomial(T[0][ramp], T[1][ramp], 1)[0])
    ratio = rate / wanted
    if abs(ratio - 1.0) <= _OFF:
        return
    weight: Weight = "fault" if not 1.0 - 2.0 * _OFF < ratio < 1.0 + 3.0 * _OFF else "doubt"
    text = f"heating rate {rate:.3g} K/min, {wanted:g} in the name"
    if 50.0 < ratio < 70.0 or 1 / 70.0 < ratio < 1 / 50.0:
        text += ": is the time in s or in min?"
    seen.say("heating rate", weight, text)


def check_range(seen: Examined) -> None:
    """Look for temperatures in the wrong unit, at impossible values, or not at the room's."""
    for signal in temperatures(seen):
        lowest, largest, first = signal.y.min(), signal.y.max(), signal.y[0]
        if largest < 1.0:
            continue
        if lowest < _POSSIBLE_K[0] and 0.0 <= first < 150.0:
            text = f"begins at {first:.4g} K: degrees Celsius under the unit '{signal.unit}'?"
            seen.say("temperature unit", "fault", text, signal.header)
        elif lowest < _POSSIBLE_K[0] or largest > _POSSIBLE_K[1]:
            out = (signal.y < _POSSIBLE_K[0]) | (signal.y > _POSSIBLE_K[1])
            at = signal.x[np.flatnonzero(out)[0]]
            text = f"{out.sum()} impossible values, first {signal.y[out][0]:.4g} K at {at:g} s"
            seen.say("temperature", "fault", text, signal.header)
        elif is_slab(seen) and not _ROOM_K[0] < first < _ROOM_K[1]:
            text = f"begins at {first:.4g} K, not at a room's temperature"
            seen.say("initial level", "doubt", text, signal.header)
        elif is_slab(seen) and lowest < first - 15.0:
            at = signal.x[int(signal.y.argmin())]
            text = f"falls to {lowest:.4g} K at {at:g} s, below the first value {first:.4g} K"
            seen.say("temperature", "doubt", text, signal.header)


def check_place(seen: Examined) -> None:
    """Look for a temperature taken for that of the back which rises as the front does."""
    for signal in temperatures(seen):
        if not is_back(signal) or signal.y.size < FEWEST_POINTS:
            continue
        if (rise := early_rise_K(signal.x, signal.y)) > FRONT_K:
            text = f"rises by {rise:.0f} K in the first 5 % of the test: the front or the gas?"
            seen.say("place", "doubt", text, signal.header)


def _heated(seen: Examined) -> tuple[FloatArray, FloatArray] | None:
    for signal in seen.signals.values():
        if signal.temperature_K is not None:
            return signal.x, signal.temperature_K
    return None
