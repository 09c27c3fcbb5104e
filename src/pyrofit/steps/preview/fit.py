"""The set that comes nearest to all records at once: short descents from the best sets drawn."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.config import Study
from pyrofit.estimate.bounded_least_squares import Fit, minimise
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.preview.reach import (
    Channel,
    Curves,
    Reached,
    RecordedCases,
    all_reached,
    simulate_all,
)
from pyrofit.steps.preview.sets import Sets

STEP = 0.01
"""Step of the derivatives, as a share of the limits."""
STARTS = 2
"""Best sets drawn from which descents begin."""
MOST_STEPS = 25
GAIN = 1e-5
"""Fall of the mean square difference below which the descent ends."""
FAILED = 10.0
"""Difference of a run that does not finish, over the range."""


@dataclass(frozen=True, eq=False)
class Nearest:
    """The set that comes nearest to all records.

    Parameters
    ----------
    unit
        Its position between the limits, 0 to 1, shape (parameters,).
    left
        Its difference from each record over the range (root mean square).
    """

    unit: FloatArray
    left: Mapping[Channel, float]


def relative_misfits(found: Mapping[Channel, Reached]) -> FloatArray:
    """Return the root mean square differences over the ranges, shape (sets, records)."""
    return np.column_stack([one.nearest for one in found.values()])


def nearest(
    study: Study,
    case: RecordedCases,
    sets: Sets,
    curves: Curves,
    suffices: Callable[[Mapping[Channel, float]], bool] = lambda left: False,
) -> Nearest:
    """Return the set that comes nearest to all records.

    The sum over the records of mean ((y - d) / R)^2 is made small, with curve y, data d, range R.

    Parameters
    ----------
    study, case
        The study, and its experiments and records.
    sets, curves
        Sets and their curves, from which the descents begin.
    suffices
        Tells from the differences that a descent leaves whether no further one is needed.
    """
    found = all_reached(case, curves)
    if not (sets.names and found):
        return Nearest(np.empty(0), {c: float(one.nearest.min()) for c, one in found.items()})
    scales = {channel: one.scale for channel, one in found.items()}
    best = np.argsort(np.mean(relative_misfits(found) ** 2, axis=1), kind="stable")[:STARTS]

    def rows(unit: FloatArray) -> FloatArray:
        made = simulate_all(study, case, replace(sets, unit=unit))
        parts = []
        for channel, one in found.items():
            off = (made[channel] - one.value) / scales[channel] / np.sqrt(one.value.size)
            parts.append(np.where(np.isfinite(off), off, FAILED))
        return np.concatenate(parts, axis=1)

    def slopes(x: FloatArray, r: FloatArray) -> FloatArray:
        steps = np.where(x + STEP > 1.0, -STEP, STEP)
        moved = x + np.diag(steps)
        return np.asarray(((rows(moved) - r).T) / steps)

    def alone(x: FloatArray) -> FloatArray:
        return np.asarray(rows(x[None])[0])

    ends = np.cumsum([one.value.size for one in found.values()])[:-1]

    def left(fit: Fit) -> dict[Channel, float]:
        parts = np.split(fit.residuals, ends)
        return {c: float(np.sqrt(np.sum(part**2))) for c, part in zip(found, parts, strict=True)}

    fits: list[Fit] = []
    for i in best:
        fits.append(minimise(alone, slopes, sets.unit[i], GAIN, most_steps=MOST_STEPS))
        if suffices(left(fits[-1])):
            break
    fit = min(fits, key=lambda one: one.chi2)
    return Nearest(fit.x, left(fit))
