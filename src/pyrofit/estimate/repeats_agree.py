"""Whether records that repeat each other agree, and in what they differ.

Each record is compared with the median of the others over a common abscissa. Level, stretch and
start are fitted to it (`pyrofit.estimate.warp`); the rest is a difference of shape. A
record that differs by more than repeats of one laboratory do is named, and the others are compared
again without it. It is another sample, another thermocouple, or a fault.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.warp import Warp, warp_to
from pyrofit.quantities.base import Quantity
from pyrofit.solver.arrays import FloatArray

POINTS = 200
"""Points of the common abscissa."""
HELD_K = 15.0
"""Rise of the temperature, while a record changes, below which it is held."""


@dataclass(frozen=True)
class Tolerance:
    """Largest usual differences: start, level over the range of the record, shape likewise.

    The start is in the unit of the abscissa, or a share of the record where it is relative.
    """

    start: float
    level: float
    shape: float
    relative: bool = False


HEATED = Tolerance(start=8.0, level=0.05, shape=0.04)
"""Of a heated sample, against temperature [K]."""
FLOWING = Tolerance(start=8.0, level=0.3, shape=0.2)
"""Of the heat flow to or from such a sample, whose baseline drifts."""
HELD = Tolerance(start=0.06, level=0.05, shape=0.04, relative=True)
"""Of a sample whose temperature is held, against time."""
BURNING = Tolerance(start=0.06, level=0.15, shape=0.10, relative=True)
"""Of a slab, against time."""


def is_held(temperature_K: FloatArray, value: FloatArray) -> bool:
    """Tell whether the temperature hardly rises from a tenth to nine tenths of the change.

    Such a record is a curve over time; over temperature it is a point.

    >>> T = np.minimum(np.linspace(300.0, 900.0, 100), 560.0)
    >>> is_held(T, np.linspace(1.0, 0.2, 100)), is_held(np.full(100, 560.0), T)
    (False, True)
    """
    change = np.abs(value - np.median(value[:3]))
    share = change / max(float(np.median(change[-3:])), 1e-300)
    inside = np.flatnonzero((share > 0.1) & (share < 0.9))
    if inside.size < 2:
        return bool(np.ptp(temperature_K) < HELD_K)
    return bool(np.ptp(temperature_K[inside[0] : inside[-1] + 1]) < HELD_K)


def tolerance_of(quantity: Quantity, held: bool = False) -> Tolerance:
    """Return the usual differences of a quantity, of samples at a held temperature or not."""
    if held:
        return HELD
    if not quantity.against_temperature:
        return BURNING
    return FLOWING if quantity.drift_share else HEATED


@dataclass(frozen=True)
class Difference:
    """A record that differs from the others that repeat it.

    Parameters
    ----------
    position
        Of the record among the repeats.
    kind
        'start', 'level' or 'shape'.
    size
        Difference of the start in the unit of the abscissa; of level and shape over the range.
    low, high
        Where the shape differs most, in the unit of the abscissa.
    """

    position: int
    kind: str
    size: float
    low: float
    high: float


def differences(
    at: Sequence[FloatArray], values: Sequence[FloatArray], tolerance: Tolerance
) -> list[Difference]:
    """Return the records that differ from their repeats; of two, the second stands for both.

    Parameters
    ----------
    at, values
        Abscissa (temperature or time) and values of every record, shape (n,) each.
    tolerance
        Differences that are usual.
    """
    low, high = max(float(a[0]) for a in at), min(float(a[-1]) for a in at)
    if len(at) < 2 or not low < high:
        return []
    grid = np.linspace(low, high, POINTS)
    records = np.array([np.interp(grid, a, v) for a, v in zip(at, values, strict=True)])
    left, found = list(range(len(records))), []
    while len(left) > 1:
        compared = [_compared(grid, records, i, left, tolerance) for i in left]
        worst = max(compared, key=lambda one: one.share)
        if worst.share <= 1.0:
            break
        if len(left) == 2:
            worst = compared[1]
        found.append(worst.difference)
        left.remove(worst.difference.position)
    return sorted(found, key=lambda one: one.position)


@dataclass(frozen=True)
class _Compared:
    difference: Difference
    share: float
    """Difference over the usual one."""


def _compared(
    grid: FloatArray, records: FloatArray, i: int, left: Sequence[int], tolerance: Tolerance
) -> _Compared:
    """Compare a record with the median of the others that are left."""
    others = np.median(records[[k for k in left if k != i]], axis=0)
    warp = warp_to(grid, others, records[i], tolerance.relative)
    sizes = _sizes(warp, max(float(np.ptp(others)), 1e-300), grid[-1] - grid[0])
    length = grid[-1] - grid[0] if tolerance.relative else 1.0
    share = np.abs(sizes) / [tolerance.start * length, tolerance.level, tolerance.shape]
    # Level and start mean little where the shape is another.
    kind = 2 if share[2] > 1.0 else int(np.argmax(share))
    off = np.abs(warp.left) >= 0.5 * np.max(np.abs(warp.left))
    low, high = (float(end) for end in grid[off][[0, -1]])
    named = Difference(i, ("start", "level", "shape")[kind], float(sizes[kind]), low, high)
    return _Compared(named, float(share.max()))


def _sizes(warp: Warp, span: float, length: float) -> FloatArray:
    """Return start, level and shape of a record against the others."""
    shape = root_mean_square(warp.left) / span
    return np.array([warp.start * length, warp.level - 1.0, shape])
