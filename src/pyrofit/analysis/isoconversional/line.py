"""The line that gives an activation energy, and its error: shared by all methods.

Each method is y = c - E x at one level of conversion, one point for each condition, where y is the
logarithm of a rate or of an integral, and x = 1/(R T). The slope is that of least squares, repeats
of a condition are averaged. Its variance is

    var(E) = S^2 sum_i (x_i - X)^2 s_i^2 / (sum_i (x_i - X)^2)^2,

where X is the mean of x, s_i the standard deviation of y_i by the scatter of points and by the
temperature of each record. S is the root mean square of residual over s of the levels nearby where
this is above 1: the points are no line to within s.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.solver.arrays import FloatArray

NEAR = 2
"""Levels on each side whose residuals tell S."""
WIDTH = 1.959963984540054
"""Half width of a 95 % interval in standard deviations."""


@dataclass(frozen=True, eq=False)
class Points:
    """Points of a line for every record and level, shape (records, levels); nan = not reached."""

    x: FloatArray
    y: FloatArray
    sd: FloatArray


@dataclass(frozen=True, eq=False)
class Energies:
    """Activation energies [J/mol] over conversion; nan where fewer than two conditions tell it.

    Parameters
    ----------
    value, error
        E, and half the width of its 95 % interval, shape (levels,).
    stretch
        S, by which the errors are widened.
    """

    value: FloatArray
    error: FloatArray
    stretch: FloatArray


def slopes(points: Points, groups: Sequence[Sequence[int]]) -> Energies:
    """Return E of lines through the means of groups of records."""
    x, y, variance = (
        np.array([[_mean(a[list(group), k]) for group in groups] for k in range(a.shape[1])])
        for a in (points.x, points.y, points.sd * points.sd)
    )
    count = np.array(
        [[np.isfinite(points.y[list(g), k]).sum() for g in groups] for k in range(x.shape[0])]
    )
    variance = variance / np.maximum(count, 1)
    found = [_line(*row) for row in zip(x, y, variance, strict=True)]
    value, sd, misfit, freedom = (np.array(column) for column in zip(*found, strict=True))
    stretch = _stretch(misfit, freedom)
    return Energies(value, WIDTH * sd * stretch, stretch)


def counted(value: FloatArray) -> FloatArray:
    """Return the E [J/mol] that an error of the temperature counts with at each level.

    It is the median over the levels at least: where E is wrong it may be near 0, and the error
    would vanish with it.
    """
    size = np.abs(value[np.isfinite(value)])
    return np.asarray(np.maximum(np.abs(value), np.median(size) if size.size else 0.0))


def _mean(a: FloatArray) -> float:
    known = a[np.isfinite(a)]
    return float(known.mean()) if known.size else float("nan")


def _line(x: FloatArray, y: FloatArray, variance: FloatArray) -> tuple[float, float, float, int]:
    """Return E, its standard deviation, the sum of squared residuals over s^2, and its freedom."""
    known = np.isfinite(x) & np.isfinite(y)
    x, y, variance = x[known], y[known], variance[known]
    apart = x - x.mean() if x.size else x
    square = float((apart * apart).sum())
    if x.size < 2 or square <= 0.0:
        return float("nan"), float("nan"), 0.0, 0
    slope = float((apart * y).sum()) / square
    residual = y - y.mean() - slope * apart
    sd = float(np.sqrt((apart * apart * variance).sum())) / square
    noisy = variance > 0.0
    misfit = float((residual[noisy] * residual[noisy] / variance[noisy]).sum())
    return -slope, sd, misfit, x.size - 2


def _stretch(misfit: FloatArray, freedom: FloatArray) -> FloatArray:
    """Return S at each level."""
    found = np.ones(misfit.size)
    for i in range(misfit.size):
        near = slice(max(0, i - NEAR), i + NEAR + 1)
        if freedom[near].sum() > 0:
            found[i] = max(1.0, float(np.sqrt(misfit[near].sum() / freedom[near].sum())))
    return found
