"""Profiles of chi-square, and the intervals read from them."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from pyrofit.constants import QUANTILE
from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.solver.arrays import FloatArray

MOST_POINTS = 12
"""Most points of a side of a profile."""
MOST_REFINED = 8
"""Most points added where a profile crosses the level."""
CLOSE = 2e-3
"""Two points this near to each other need none between."""
NEAR = 0.03
"""A point this near to the level is near enough to interpolate from."""


@dataclass(frozen=True)
class Interval:
    """A 95 % interval within the limits; an end is open where the limit cuts it off."""

    low: float
    high: float
    low_open: bool = False
    high_open: bool = False

    @property
    def width(self) -> float:
        """High less low."""
        return self.high - self.low


@dataclass(frozen=True, eq=False)
class Profile:
    """Rise of chi-square over its least value against one parameter, all others at their best."""

    x: FloatArray
    rise: FloatArray

    def interval(self, dispersion: float) -> Interval:
        """Return where the rise is below 3.84 times the dispersion, s^2."""
        top = QUANTILE * math.sqrt(dispersion)
        root = np.sqrt(np.maximum(self.rise, 0.0))
        least = int(np.argmin(root))
        # The root of a parabola is a straight line, which interpolates well.
        low = _crossing(self.x[least::-1], root[least::-1], top)
        high = _crossing(self.x[least:], root[least:], top)
        return Interval(*(low or (0.0,)), *(high or (1.0,)), low is None, high is None)


def _crossing(x: FloatArray, root: FloatArray, top: float) -> tuple[float] | None:
    """Return where a side of a profile first reaches a height, None where it does not."""
    above = np.flatnonzero(root >= top)
    if not above.size:
        return None
    k = int(above[0])
    share = (top - root[k - 1]) / (root[k] - root[k - 1])
    return (float(x[k - 1] + share * (x[k] - x[k - 1])),)


class Descend(Protocol):
    """A descent of chi-square beside a parameter that is kept."""

    def __call__(self, x: FloatArray, *, fixed: int) -> Fit:
        """Return the least chi-square from x."""


def profile_of(
    descend: Descend,
    optimum: Fit,
    i: int,
    follow: FloatArray,
    sd: float,
    dispersion: float,
) -> tuple[Profile, Fit]:
    """Return the profile of a parameter as far as the interval reaches, and its lowest point."""
    line = _Line(descend, optimum, i, follow)
    top = QUANTILE * math.sqrt(dispersion)
    ends = [optimum]
    for sign in (-1.0, 1.0):
        side = _outwards(line, sign * sd, top)
        for level in {QUANTILE, top}:
            side = _refined(line, side, level)
        ends += side[1:]
    ends.sort(key=lambda end: float(end.x[i]))
    rise = np.array([end.chi2 - optimum.chi2 for end in ends])
    lowest = min(ends, key=lambda end: end.chi2)
    return Profile(np.array([end.x[i] for end in ends]), rise), lowest


@dataclass(frozen=True, eq=False)
class _Line:
    """One parameter at given values, all others at their best."""

    descend: Descend
    optimum: Fit
    i: int
    follow: FloatArray
    """How the others move with it, about the optimum."""

    def at(self, value: float, near: Fit) -> Fit:
        """Return the least chi-square at a value, searched from a point of another value."""
        x = np.clip(near.x + (value - near.x[self.i]) * self.follow, 0.0, 1.0)
        x[self.i] = value
        return self.descend(x, fixed=self.i)

    def root(self, end: Fit) -> float:
        """Return the root of the rise of chi-square: distance in sd, were it a parabola."""
        return float(np.sqrt(max(end.chi2 - self.optimum.chi2, 0.0)))


def _outwards(line: _Line, reach: float, top: float) -> list[Fit]:
    """Return points from the optimum outwards, the last at the limit or with a root above top."""
    limit = 1.0 if reach > 0.0 else 0.0
    side = [line.optimum]
    move = reach
    while len(side) <= MOST_POINTS and line.root(side[-1]) < top and side[-1].x[line.i] != limit:
        last = side[-1]
        value = float(np.clip(last.x[line.i] + move, 0.0, 1.0))
        # No room for another point before the limit: take the limit.
        value = limit if abs(limit - value) < 0.3 * abs(move) else value
        side.append(line.at(value, last))
        now = line.root(side[-1])
        pace = max(now - line.root(last), 0.1 * top) / abs(value - last.x[line.i])
        wanted = max(0.55 * top, 1.03 * top - now) / pace
        move = float(np.copysign(min(wanted, 3.0 * abs(reach)), reach))
    return side


def _refined(line: _Line, side: list[Fit], level: float) -> list[Fit]:
    """Add points where a side crosses a level, until one is near to it."""
    side = list(side)
    for step in range(MOST_REFINED):
        above = [k for k, end in enumerate(side) if line.root(end) >= level]
        if not above or above[0] == 0:
            break
        low, high = side[above[0] - 1], side[above[0]]
        roots = line.root(low), line.root(high)
        close = abs(high.x[line.i] - low.x[line.i]) < CLOSE
        if close or min(abs(root - level) for root in roots) <= NEAR * level:
            break
        # The straight line where there is no bend; behind a bend it creeps and the middle does not.
        share = 0.5 if step else (level - roots[0]) / (roots[1] - roots[0])
        value = low.x[line.i] + share * (high.x[line.i] - low.x[line.i])
        side.insert(above[0], line.at(float(value), low))
    return side
