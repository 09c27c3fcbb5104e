"""Windows of a series in which whitened residuals are off to one side.

For a window of L of a channel's n whitened residuals w the statistic is
|sum w|/sqrt(L) - sqrt(2 log(n/L)): short windows, of which there are many, must stand out more
(Duembgen and Spokoiny 2001, doi 10.1214/aos/996986504). Where the largest is above a critical
value, its window is noted and both sides are searched on, as in narrowest-significance pursuit
(Fryzlewicz 2024, doi 10.1080/01621459.2023.2211733).
"""

from dataclasses import dataclass

import numpy as np

from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True)
class Stretch:
    """Points ``start`` to ``end`` (excluded) of a channel that are off to one side."""

    channel: int
    start: int
    end: int
    statistic: float
    sign: int


def windows_of(w: FloatArray, critical: float, channel: int = 0, most: int = 8) -> list[Stretch]:
    """Return the windows of a channel above the critical value, ``most`` at most, in order."""
    found: list[Stretch] = []
    waiting = [(0, w.size)]
    while waiting and len(found) < most:
        low, high = waiting.pop(0)
        best = _best(w, low, high)
        if best is None or best[0] <= critical:
            continue
        value, start, end = best
        sign = 1 if w[start:end].sum() > 0.0 else -1
        found.append(Stretch(channel, start, end, value, sign))
        waiting += [(low, start), (end, high)]
    return sorted(found, key=lambda window: window.start)


def _best(w: FloatArray, low: int, high: int) -> tuple[float, int, int] | None:
    """Return statistic, start and end of the window that stands out most."""
    best = None
    total = np.concatenate([[0.0], np.cumsum(w[low:high])])
    for length in _lengths(high - low):
        sums = np.abs(total[length:] - total[:-length]) / np.sqrt(length)
        at = int(sums.argmax())
        value = float(sums[at]) - _handicap(w.size, length)
        if best is None or value > best[0]:
            best = value, low + at, low + at + length
    return best


def highest(w: FloatArray) -> FloatArray:
    """Return the largest statistic of each column of (points, draws), shape (draws,)."""
    total = np.concatenate([np.zeros((1, w.shape[1])), np.cumsum(w, axis=0)])
    found = np.full(w.shape[1], -np.inf)
    for length in _lengths(len(w)):
        sums = np.abs(total[length:] - total[:-length]).max(axis=0) / np.sqrt(length)
        found = np.maximum(found, sums - _handicap(len(w), length))
    return found


def _lengths(points: int) -> list[int]:
    """Return lengths of windows, each about sqrt(2) times the one before.

    >>> _lengths(12)
    [1, 2, 3, 4, 6, 8, 11]
    """
    found, k = [], 0
    while (length := round(2.0 ** (0.5 * k))) <= points:
        found += [length, 3] if length == 2 and points > 2 else [length]
        k += 1
    return list(dict.fromkeys(found))


def _handicap(points: int, length: int) -> float:
    return float(np.sqrt(2.0 * functions.log(points / length)))
