"""A record as conversion over time, and what it tells at levels of conversion."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

REACHES = 0.015, 0.06
"""Least and largest distance in conversion of the points that a local parabola is fitted to."""
PRECISION = 0.005
"""Relative error of a rate by noise that the distance is chosen for."""
MASS_SD = 3e-3
"""Standard deviation of a record's mass over its initial mass, by the drift of the balance."""
FEWEST = 7
"""Fewest points of a local parabola."""
_NEWTON = 20
_END = 0.02
"""Share of the points at each end of a record whose mean is its first or last mass."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Conversion of a small sample that follows a temperature programme.

    Parameters
    ----------
    name
        Name of the experiment.
    condition
        Name of its programme; records of equal condition are repeats.
    rate_K_min
        Nominal heating rate [K/min]; none of a programme that has no constant rate.
    time_s, temperature_K, conversion
        Shape (n,), times increasing.
    lost
        Mass lost from first to last, over the initial mass.
    """

    name: str
    condition: str
    rate_K_min: float | None
    time_s: FloatArray
    temperature_K: FloatArray
    conversion: FloatArray
    lost: float

    @property
    def ends(self) -> int:
        """Number of points at each end whose mean is the first or last mass."""
        return _points_of_end(self.time_s.size)

    def scaled(self, lost: float) -> "Curve":
        """Return the curve with another loss of mass at complete conversion."""
        return replace(self, conversion=self.conversion * (self.lost / lost), lost=lost)


@dataclass(frozen=True, eq=False)
class Crossing:
    """Where a record reaches levels of conversion; nan where it does not.

    Parameters
    ----------
    time_s, temperature_K, heating_K_s
        Time, temperature and heating rate, shape (levels,).
    rate
        Rate of conversion [1/s].
    time_sd, log_rate_sd
        Standard deviations of the time [s] and of the logarithm of the rate, by the scatter of
        the points about the local parabolas.
    level_sd
        Standard deviation of the time [s] by the drift of the balance, which shifts the levels.
    """

    time_s: FloatArray
    temperature_K: FloatArray
    heating_K_s: FloatArray
    rate: FloatArray
    time_sd: FloatArray
    log_rate_sd: FloatArray
    level_sd: FloatArray


def curve_of(
    name: str,
    condition: str,
    rate_K_min: float | None,
    time_s: FloatArray,
    temperature_K: FloatArray,
    mass: FloatArray,
    last: float | None = None,
) -> Curve:
    """Return the conversion (m_first - m)/(m_first - m_last) of a record.

    Parameters
    ----------
    name, condition, rate_K_min
        See `Curve`.
    time_s, temperature_K, mass
        The record, shape (n,); mass over its initial mass.
    last
        Mass at complete conversion; default: the mean of the last points.
    """
    at_end = _points_of_end(mass.size)
    first = float(np.mean(mass[:at_end]))
    last = float(np.mean(mass[-at_end:])) if last is None else last
    lost = first - last
    conversion = (first - mass) / lost if lost > 0.0 else np.zeros(mass.size)
    return Curve(name, condition, rate_K_min, time_s, temperature_K, conversion, lost)


def _points_of_end(points: int) -> int:
    return max(3, int(_END * points))


def reach_of(curve: Curve) -> float:
    """Return the distance in conversion from which a parabola takes points for a precise rate.

    Of N points per unit of conversion, with noise s, those within the distance d tell the rate with
    a relative error p of s sqrt(12/(2 N d))/(2 d). The noise is that of third differences.
    """
    third = np.diff(curve.conversion, 3)
    noise = float(np.median(np.abs(third))) / 0.6745 if third.size else 0.0
    inside = (curve.conversion > 0.05) & (curve.conversion < 0.95)
    density = max(float(inside.sum()), 1.0) / 0.9
    square = noise * noise / 20.0
    reach = float(functions.cube_root(1.5 * square / (density * PRECISION * PRECISION)))
    return min(max(reach, REACHES[0]), REACHES[1])


def crossing(curve: Curve, levels: FloatArray, reach: float) -> Crossing:
    """Return where a record reaches levels of conversion, by local parabolas of conversion.

    Each parabola is fitted to the points whose conversion is at most ``reach`` from the level. Near
    the ends, 0.6 of the distance to the nearest end replaces a larger reach. At equal conversion,
    curves of different rates have nearly the same shape, so that its bias is nearly the same.
    """
    steady = _rising(curve.conversion)
    rows = np.full((levels.size, 4), np.nan)
    squares, freedom = 0.0, 0
    for i, level in enumerate(levels.tolist()):
        part = _window(steady, level, reach)
        found = part and _local(curve.time_s[part], curve.conversion[part], level)
        if found:
            rows[i] = found[:4]
            squares += found.square
            freedom += found.freedom
    time, rate, of_value, of_rate = rows.T
    variance = squares / max(freedom, 1)
    # The first and the last mass are uncertain as well: both shift the conversion.
    ends = (levels * levels + (1.0 - levels) * (1.0 - levels)) / curve.ends
    return Crossing(
        time_s=time,
        temperature_K=np.interp(time, curve.time_s, curve.temperature_K),
        heating_K_s=_heating(curve, time),
        rate=rate,
        time_sd=np.sqrt(variance * (of_value + ends)) / rate,
        log_rate_sd=np.sqrt(variance * of_rate) / rate,
        level_sd=MASS_SD / (curve.lost * rate),
    )


def _heating(curve: Curve, time: FloatArray) -> FloatArray:
    """Return dT/dt [K/s] over a fiftieth of the record about some times."""
    first, last = float(curve.time_s[0]), float(curve.time_s[-1])
    half = 0.5 * _END * (last - first)
    ends = [np.clip(time + by, first, last) for by in (-half, half)]
    below, above = (np.interp(end, curve.time_s, curve.temperature_K) for end in ends)
    return np.asarray((above - below) / (ends[1] - ends[0]))


def _rising(conversion: FloatArray) -> FloatArray:
    """Return the running mean of five points, made to rise."""
    return np.asarray(np.maximum.accumulate(linear.running_mean(conversion, 5)))


def _window(steady: FloatArray, level: float, reach: float) -> slice | None:
    """Return the points about a level; none where the record does not reach it."""
    if not steady[0] < level < steady[-1] or steady.size < FEWEST:
        return None
    reach = min(reach, 0.6 * level, 0.6 * (1.0 - level))
    first = int(np.searchsorted(steady, level - reach))
    end = int(np.searchsorted(steady, level + reach))
    lacking = FEWEST - (end - first)
    if lacking > 0:
        first = max(0, first - (lacking + 1) // 2)
        end = min(steady.size, first + FEWEST)
        first = max(0, end - FEWEST)
    return slice(first, end)


class _Local(NamedTuple):
    """Time and rate where a parabola reaches a level, and how far the points scatter about it.

    The variances of conversion and rate there are given over that of a point.
    """

    time_s: float
    rate: float
    of_value: float
    of_rate: float
    square: float
    freedom: int


def _local(time: FloatArray, conversion: FloatArray, level: float) -> _Local | None:
    """Fit a parabola to points about a level; none where it does not rise there."""
    middle = 0.5 * float(time[0] + time[-1])
    half = 0.5 * float(time[-1] - time[0])
    u = (time - middle) / half
    design = np.column_stack([np.ones(u.size), u, u * u])
    inverse = linear.inverse(linear.gram(design))
    c0, c1, c2 = linear.product(inverse, design.T, conversion).tolist()
    residual = conversion - (c0 + c1 * u + c2 * u * u)
    at = 0.0
    for _ in range(_NEWTON):
        slope = c1 + 2.0 * c2 * at
        if slope <= 0.0:
            return None
        at -= (c0 + c1 * at + c2 * at * at - level) / slope
        at = min(max(at, -1.5), 1.5)
    slope = c1 + 2.0 * c2 * at
    if slope <= 0.0:
        return None
    value, change = np.array([1.0, at, at * at]), np.array([0.0, 1.0, 2.0 * at])
    return _Local(
        time_s=middle + half * at,
        rate=slope / half,
        of_value=linear.dot(value, linear.product(inverse, value)),
        of_rate=linear.dot(change, linear.product(inverse, change)) / (half * half),
        square=linear.dot(residual, residual),
        freedom=u.size - 3,
    )
