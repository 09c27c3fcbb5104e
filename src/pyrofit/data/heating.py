"""Where the heating of a sample ends: at a cooling, a change of gas, or a burn-off."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from pyrofit.data.csvfile import FloatArray
from pyrofit.data.stated import Stated
from pyrofit.quantities.base import Quantity

COOLED_K = 20.0
"""Fall of the temperature from which on a record counts as cooling."""
PYROLYSED_K = 500.0
"""Heated so far, a sample has reacted; a cooling from below is one after a drying."""
SPANS = 30
"""Equal spans of temperature over which the rise of a record is looked at."""
_HELD_K = 5.0
_PARTS = 20
_FEWEST = 3 * _PARTS
_BURNT, _LOST, _FASTER, _STARTED = 0.02, 0.005, 3.0, 0.003
"""Least loss of a burn-off, in all and in a part of a hold; least ratio of its rate to the one
before; loss at which it starts. Masses are fractions of the initial mass."""


class EndOfHeating(NamedTuple):
    """The end of the heating: its time [s], and the reason in words."""

    time_s: float
    why: str


def end_of_heating(
    frame: pd.DataFrame, quantity: Quantity, stated: Stated | None = None
) -> EndOfHeating | None:
    """Return the earliest end of the heating of a sample; None where the whole record is one.

    Parameters
    ----------
    frame
        A series with ``time_s``, ``temperature_K`` and the column of the quantity.
    quantity
        The measured quantity; that of a mass shows a burn-off as well.
    stated
        Facts that the file states, such as a change of gas.

    Examples
    --------
    >>> from pyrofit.quantities import known_quantities
    >>> t = np.arange(0.0, 100.0)
    >>> T = 300.0 + np.minimum(10.0 * t, 600.0 - 5.0 * np.maximum(t - 80.0, 0.0))
    >>> frame = pd.DataFrame({"time_s": t, "temperature_K": T, "heat_flow_W_kg": 0.0 * t})
    >>> end_of_heating(frame, known_quantities()["heat_flow"])
    EndOfHeating(time_s=81.0, why='from then on the record cools, which is no heating')
    """
    time, T = (frame[c].to_numpy(float) for c in ("time_s", "temperature_K"))
    ends = []
    if (cools := cooling_from_s(time, T)) is not None:
        ends.append(EndOfHeating(cools, "from then on the record cools, which is no heating"))
    if stated is not None and stated.then_gas and stated.then_gas_s is not None:
        ends.append(EndOfHeating(stated.then_gas_s, f"from then on the gas is {stated.then_gas}"))
    mass = frame[quantity.column].to_numpy(float)
    is_mass = quantity.scales[0] == "fraction" and "mass" in quantity.scales
    if is_mass and (burns := burning_from_s(time, T, mass)) is not None:
        why = "from then on the mass falls anew at a held temperature, as after a change of gas"
        ends.append(EndOfHeating(burns, why))
    ends = [end for end in ends if time[0] < end.time_s < time[-1]]
    return min(ends, default=None)


def cooling_from_s(time_s: FloatArray, temperature_K: FloatArray) -> float | None:
    """Return the time [s] from which on a record cools: at its end, or after the first pyrolysis.

    A hold at the highest temperature belongs to the heating. So does a cooling after a drying.

    >>> T = np.r_[np.arange(300.0, 900.0, 10.0), np.arange(900.0, 300.0, -20.0)]
    >>> cooling_from_s(np.arange(120.0), np.r_[T, np.arange(300.0, 900.0, 20.0)])
    60.0
    """
    highest = np.maximum.accumulate(temperature_K)
    falls = highest - temperature_K > COOLED_K
    first = np.flatnonzero(falls & (highest > PYROLYSED_K))
    if first.size:
        end = int(first[0])
    elif falls[-1] and temperature_K.max() - temperature_K[-1] > COOLED_K:
        end = temperature_K.size - 1
    else:
        return None
    hot = np.flatnonzero(temperature_K[: end + 1] > highest[end] - 0.5 * COOLED_K)
    return float(time_s[int(hot[-1])])


def burning_from_s(time_s: FloatArray, temperature_K: FloatArray, mass: FloatArray) -> float | None:
    """Return the time [s] at which the mass falls anew while the highest temperature is held.

    At one temperature and in one gas a rate does not rise again: this is a burn-off of char.

    >>> t = np.arange(0.0, 2400.0, 5.0)
    >>> T = np.minimum(300.0 + 0.5 * t, 900.0)
    >>> burning_from_s(t, T, 1.0 - 0.7 * (T > 650.0) - 0.2 * np.clip((t - 1800.0) / 100.0, 0.0, 1.0))
    1800.0
    """  # noqa: E501
    held = np.flatnonzero(temperature_K < temperature_K.max() - _HELD_K)
    start = int(held[-1]) + 1 if held.size else 0
    t, m = time_s[start:], np.asarray(pd.Series(mass[start:]).rolling(5, 1, True).median(), float)
    if t.size < _FEWEST or temperature_K.max() < PYROLYSED_K:
        return None
    edges = np.linspace(0, t.size - 1, _PARTS + 1).astype(int)
    rates = -np.diff(m[edges]) / np.maximum(np.diff(t[edges]), 1e-9)
    slowest = np.minimum.accumulate(np.maximum(rates, 0.0))
    lost = m[edges[1:-1]] - m[edges[2:]]
    anew = (rates[1:] > _FASTER * slowest[:-1]) & (lost > _LOST)
    first = np.flatnonzero(anew & (m[edges[1:-1]] - m[-1] > _BURNT))
    if not first.size:
        return None
    begin, end = edges[first[0] + 1], edges[first[0] + 2]
    before = np.flatnonzero(m[:end] > m[begin] - _STARTED)
    return float(t[int(before[-1])])


def usual_rise(time: FloatArray, temperature: FloatArray) -> float:
    """Return the median rise [K/s] over equal spans of temperature; 0 where it falls as often.

    Over equal spans of time, holds and slow ends would count more, and so would readings that are
    rounded to a kelvin.

    >>> T = np.r_[np.arange(300.0, 800.0), np.linspace(800.0, 900.0, 1000)]
    >>> t = np.r_[3.0 * np.arange(500), 1500.0 + 30.0 * np.arange(1000)]
    >>> round(60.0 * usual_rise(np.rint(t), np.rint(T)), 1)
    20.0
    """
    if np.sign(np.diff(temperature)).sum() <= 0.0:
        return 0.0
    highest = np.maximum.accumulate(temperature)
    nodes = np.linspace(highest[0], highest[-1], SPANS + 1)
    rows = np.unique(np.minimum(np.searchsorted(highest, nodes), time.size - 1))
    return float(np.median(np.diff(highest[rows]) / np.diff(time[rows])))
