"""How plausible the strengths of effects of apparatus and surroundings are.

A careful description leaves a range open about the null value s_0 of a strength s. Its ends lie two
standard deviations away on either side. In units of these,

    r = 2 (s - s_0) / (high - s_0)  above s_0,    r = 2 (s - s_0) / (s_0 - low)  below it,

and r^2 counts in chi-square, as known values do.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from pyrofit.effects import known_effects
from pyrofit.solver.arrays import FloatArray

Range = tuple[float, float]
FAR = 3.0
"""Standard deviations above which a strength is not plausible."""


@dataclass(frozen=True)
class Plausible:
    """The plausible range of the strength of an effect, SI unit, about its null value."""

    low: float
    null: float
    high: float

    def residuals(self, strengths: FloatArray) -> FloatArray:
        """Return r of strengths in SI units."""
        off = strengths - self.null
        return np.asarray(off * self._per_unit(off))

    def far(self, strength: float) -> float:
        """Return |r| of a strength that is not plausible, else 0."""
        r = abs(float(self.residuals(np.array([strength]))[0]))
        return r if r > FAR else 0.0

    def slopes(self, strengths: FloatArray) -> FloatArray:
        """Return d r / d s."""
        return self._per_unit(strengths - self.null)

    def _per_unit(self, off: FloatArray) -> FloatArray:
        above, below = self.high - self.null, self.null - self.low
        # A side of no width is a limit of the strength as well: nothing lies there.
        return np.asarray(np.where(off > 0.0, 2.0 / (above or below), 2.0 / (below or above)))


def plausible_ranges(stated: Mapping[str, Range]) -> dict[str, Plausible]:
    """Return the ranges by effect, those that a study states first, in SI units."""
    found = {}
    for name, effect in known_effects().items():
        (quantity,) = effect.strength.values()
        ends = stated.get(name, quantity.plausible)
        if ends is not None:
            found[name] = Plausible(ends[0], quantity.value, ends[1])
    return found
