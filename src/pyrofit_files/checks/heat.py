"""Heat flows and heat release rates: unit and level."""

import numpy as np

from pyrofit_files.examined import Examined
from pyrofit_files.signals import heat_flow, heat_release, specific_release

_LARGEST = (
    (heat_release, 2e4, 4e6, "kW/m2"),
    (specific_release, 5e3, 2.5e6, "W/g"),
    (heat_flow, 20.0, 2e4, "W/g"),
)
"""Limits of the largest absolute value, in W/m2 or W/kg, and the unit in which it is told."""
_AREA_M2 = 0.01
_LARGEST_KW_M2 = 4e3
_NEGATIVE = 0.1
_START = 0.04


def check_heat_unit(seen: Examined) -> None:
    """Look for values that fit no usual test in the unit that is stated."""
    for find, low, high, unit in _LARGEST:
        if (signal := find(seen)) is not None:
            largest = float(np.abs(signal.y).max())
            if not low < largest < high:
                text = f"reaches {largest / 1e3:.4g} {unit}: another unit, or a factor?"
                seen.say("heat unit", "fault", text, signal.header)
    for signal in seen.signals.values():
        largest = float(signal.y.max()) / 1e3 if signal.y.size else 0.0
        if signal.scale == "heat rate" and largest / _AREA_M2 > _LARGEST_KW_M2:
            text = f"'{signal.unit}' of the whole sample, but {largest:.4g} kW: per m2 by its size"
            seen.say("heat unit", "fault", text, signal.header)


def check_level(seen: Examined) -> None:
    """Look for heat release rates below zero, or above it before the sample burns."""
    for signal in (heat_release(seen), specific_release(seen)):
        if signal is None or signal.y.size < 20 or signal.y.max() <= 0.0:
            continue
        y = signal.y / signal.y.max()
        if y.min() < -_NEGATIVE:
            at = signal.x[int(y.argmin())]
            text = f"falls to {100.0 * y.min():.3g} % of its largest value at {at:g} s"
            seen.say("heat level", "doubt", text, signal.header)
        start = float(y[0])
        if start > _START and signal.x[0] < 10.0:
            text = f"begins at {100.0 * start:.3g} % of its largest value, before anything burns"
            seen.say("initial level", "doubt", text, signal.header)
