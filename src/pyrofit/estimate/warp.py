"""A curve changed in level, stretch and start, so that it comes near to a record.

y(t) = m_0 + a (m((t - t_0 - c T) / b + t_0) - m_0) with the length T of the record.
"""

from dataclasses import dataclass

import numpy as np

from pyrofit.numerics import fitting, linear
from pyrofit.solver.arrays import FloatArray

NONE = np.array([1.0, 1.0, 0.0])
"""Level, stretch and start of a curve that is not changed."""
FARTHEST = 0.2
"""Largest start that is tried, as a fraction of the record; the largest stretch is half of it."""
TRIED = 21
"""Values of a grid."""
REFINED = 3
"""Grids, each about the best point of the one before and as wide as two of its steps."""


@dataclass(frozen=True, eq=False)
class Warp:
    """Level a, stretch b and start c of a record, and the deviations that are left, shape (n,)."""

    level: float
    stretch: float
    start: float
    left: FloatArray


def warp_to(at: FloatArray, curve: FloatArray, record: FloatArray, stretched: bool) -> Warp:
    """Return the nearest changed curve to a record, shape (n,) each.

    Starts and stretches are tried on a grid, each with its best level. A descent may end where
    steps of curve and record do not meet.

    >>> t = np.linspace(0.0, 1.0, 201)
    >>> step = lambda t: 1.0 / (1.0 + np.exp((t - 0.5) / 0.05))
    >>> round(warp_to(t, step(t), step(t - 0.03), stretched=False).start, 3)
    0.03
    """
    best, width = NONE, np.array([0.0, 0.1 if stretched else 0.0, FARTHEST])
    for _ in range(REFINED):
        steps = np.linspace(-1.0, 1.0, TRIED)
        pairs = [(b, c) for b in (steps if stretched else [0.0]) for c in steps]
        tried = [_with_level(at, curve, record, best + width * [0.0, b, c]) for b, c in pairs]
        best = min(tried, key=lambda fit: _distance(at, curve, record, fit))
        width = width * (2.0 / (TRIED - 1))
    level, stretch, start = best.tolist()
    return Warp(level, stretch, start, record - changed(at, curve, best))


def _with_level(
    at: FloatArray, curve: FloatArray, record: FloatArray, fit: FloatArray
) -> FloatArray:
    shape = changed(at, curve, np.array([1.0, fit[1], fit[2]])) - curve[0]
    level = linear.dot(shape, record - curve[0]) / max(linear.dot(shape, shape), 1e-300)
    return np.array([level, fit[1], fit[2]])


def _distance(at: FloatArray, curve: FloatArray, record: FloatArray, fit: FloatArray) -> float:
    off = record - changed(at, curve, fit)
    return linear.dot(off, off)


def fitted(at: FloatArray, curve: FloatArray, record: FloatArray) -> FloatArray:
    """Return level, stretch and start."""
    scale = max(float(np.ptp(curve)), 1e-300)
    return fitting.least_squares(lambda p: (changed(at, curve, p) - record) / scale, NONE)


def changed(at: FloatArray, curve: FloatArray, fit: FloatArray) -> FloatArray:
    """Return the changed curve."""
    level, stretch, start = fit
    own = at[0] + (at - at[0] - start * (at[-1] - at[0])) / max(stretch, 0.1)
    return np.asarray(curve[0] + level * (np.interp(own, at, curve) - curve[0]))


def unchanged(at: FloatArray, record: FloatArray, fit: FloatArray) -> FloatArray:
    """Return a record with its own level, stretch and start taken out."""
    level, stretch, start = fit
    own = at[0] + (at - at[0]) * stretch + start * (at[-1] - at[0])
    moved = np.interp(own, at, record)
    return np.asarray(moved[0] + (moved - moved[0]) / level)
