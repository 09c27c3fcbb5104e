"""Levels of conversion, and records at them, repeats joined."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.analysis.isoconversional.curve import Crossing, Curve, crossing, reach_of
from pyrofit.solver.arrays import FloatArray

LEVELS: FloatArray = np.asarray(0.05 * np.arange(1, 20), dtype=np.float64)
"""Levels of conversion, 0.05 to 0.95."""
STEP = 0.05
"""Step of conversion over which advanced Vyazovkin integrates."""


@dataclass(frozen=True, eq=False)
class RecordsAtLevels:
    """Records at levels of conversion, and at the ends of the step about each.

    Parameters
    ----------
    curves
        The records.
    levels
        Levels of conversion, shape (levels,).
    reach
        Distance in conversion of the points of local parabolas.
    at, before, after
        Each record at the levels, and half a step before and after them.
    """

    curves: tuple[Curve, ...]
    levels: FloatArray
    reach: float
    at: tuple[Crossing, ...]
    before: tuple[Crossing, ...]
    after: tuple[Crossing, ...]

    @property
    def groups(self) -> list[list[int]]:
        """Numbers of the records of each condition."""
        names = [curve.condition for curve in self.curves]
        return [[i for i, n in enumerate(names) if n == name] for name in dict.fromkeys(names)]

    def stacked(self, key: str) -> FloatArray:
        """Return a property of all records at the levels, shape (records, levels)."""
        return np.array([getattr(found, key) for found in self.at])

    def temperature_sd(self, of_record_K: float) -> FloatArray:
        """Return the standard deviation of T [K] at the levels, shape (records, levels).

        It joins that of the record, and that of the mass: dT/dt times that of the time.
        """
        shift = self.stacked("heating_K_s") * self.stacked("level_sd")
        return np.asarray(np.sqrt(shift * shift + of_record_K**2))


def runs_of(curves: Sequence[Curve], reach: float | None = None) -> RecordsAtLevels:
    """Return records at `LEVELS` of conversion.

    All have the same ``reach``, by default the largest that one of them needs.
    """
    reach = max(reach_of(curve) for curve in curves) if reach is None else reach
    at, before, after = (
        tuple(crossing(curve, LEVELS + shift, reach) for curve in curves)
        for shift in (0.0, -0.5 * STEP, 0.5 * STEP)
    )
    return RecordsAtLevels(tuple(curves), LEVELS, reach, at, before, after)
