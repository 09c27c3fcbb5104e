"""The scatter between repeats of a test, as a lasting part of their noise.

Repeat r of R records y_r = f + u_r + e_r: a curve f that all share, a random effect u_r that lasts
over the record, and noise e_r of its points. With d_r = y_r - mean and W a window that smooths over
time as that of a stated uncertainty does, variance between repeats and covariance of u_r are

    tau^2 = W (sum_r d_r^2 / (R - 1) - variance of e)
    K = q (S S^T / (R - 1) + tau tau^T * exp(-|t - t'| / l)),    S = W (d_1 ... d_R).

The first term is the covariance of the repeats. It lasts over the whole record, so that a parameter
that moves the curve alike is uncertain by as much. The second has the same size in all other
directions, of which few repeats show only few. q = (t_(R-1) / 1.96)^2 turns the quantile of a
normal distribution into Student's: R repeats tell their own scatter with R - 1 degrees of freedom
only.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import stdtrit

from pyrofit.constants import QUANTILE
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import FEWEST_POINTS, NoiseModel
from pyrofit.estimate.problem import Problem
from pyrofit.numerics import fitting, functions, linear
from pyrofit.solver.arrays import FloatArray

WINDOW = 0.2
"""Window of the smoothing, as a fraction of the record: twice that of a stated uncertainty, as a
further repeat may be steep a little before or after those that are there."""
KNOTS = 81
"""Knots of a record."""
LASTING = 0.05
"""Time l over which the second term lasts, as a fraction of the record. From 0.02 to 0.1 the
coverage of 95 % intervals changes by 0.05 at most."""
FLOOR = "repeats"
SIGNIFICANT = 2.0
"""Standard deviations by which the scatter must exceed the smoothed noise of the points."""


@dataclass(frozen=True)
class _Record:
    """One repeat: abscissa (time or temperature), values and noise, shape (n,) each."""

    at: FloatArray
    value: FloatArray
    noise: NoiseModel

    @property
    def points(self) -> tuple[FloatArray, Correlation]:
        """Standard deviation and correlation of the noise of its points.

        The discrepancy of models is none: all repeats share it.
        """
        shared = self.noise.floors.get("discrepancy")
        if shared is None:
            return self.noise.sd, self.noise.correlation
        return np.sqrt(np.maximum(self.noise.sd**2 - shared**2, 0.0)), Correlation()


def with_repeats(
    problem: Problem,
    noise: Sequence[NoiseModel],
    about: Sequence[FloatArray] | None = None,
) -> tuple[NoiseModel, ...]:
    """Return the noise of all channels with the scatter between repeats, where there are any.

    Where parameters describe the differences between repeats, only the remaining scatter counts:
    about the fitted curves ``about``, or else between the aligned records.
    """
    found = list(noise)
    for channels in _groups(problem):
        records = [_record(problem, i, noise[i], about) for i in channels]
        free = any(_differs(problem, i) for i in channels)
        for i, model in zip(channels, _of_group(records, free and about is None), strict=True):
            found[i] = model
    return tuple(found)


def _groups(problem: Problem) -> Iterator[list[int]]:
    """Yield the positions of the channels that repeat one signal of one test."""
    groups: dict[tuple[str, str], dict[str, int]] = {}
    for i, (name, signal, _) in enumerate(problem.picks):
        repeat = getattr(problem.runs[name].experiment, "repeat", None)
        if repeat is not None:
            groups.setdefault((repeat.test, signal), {}).setdefault(name, i)
    for channels in groups.values():
        if len(channels) > 1:
            yield list(channels.values())


def _differs(problem: Problem, channel: int) -> bool:
    repeat = problem.runs[problem.picks[channel][0]].experiment.repeat
    assert repeat is not None
    return any(name in problem.names for name in repeat.nuisances.values())


def _record(
    problem: Problem, channel: int, noise: NoiseModel, about: Sequence[FloatArray] | None
) -> _Record:
    name, signal, index = problem.picks[channel]
    target = problem.cost.terms[channel][1].target
    temperature = problem.runs[name].requests[signal].temperature_K
    at = target.time_s if temperature is None else temperature[index]
    value = target.value if about is None else target.value - about[channel]
    return _Record(at, value, noise)


def _of_group(records: Sequence[_Record], align: bool) -> list[NoiseModel]:
    """Return the noise of records that repeat each other."""
    low = max(float(r.at.min()) for r in records)
    high = min(float(r.at.max()) for r in records)
    first = records[0].at
    grid = first[(first >= low) & (first <= high)]
    if grid.size < FEWEST_POINTS:
        return [r.noise for r in records]
    knots = np.linspace(low, high, KNOTS)
    window = _window(grid, knots)
    values = np.array([np.interp(grid, r.at, r.value) for r in records])
    deviations = _aligned(grid, values, window, knots) if align else values - values.mean(axis=0)
    freedom = len(records) - 1
    of_points = np.mean([np.interp(grid, r.at, r.points[0] ** 2) for r in records], axis=0)
    variance = np.sum(deviations**2, axis=0) / freedom
    shown = linear.product(deviations, window.T)
    left = np.mean([_left(_window(r.at, knots), *r.points) for r in records], axis=0)
    if not _significant(np.sum(shown**2, axis=0) / freedom, left, freedom):
        return [r.noise for r in records]
    tau = np.sqrt(np.maximum(linear.product(window, variance - of_points), 0.0))
    modes = _modes(knots, shown, tau)
    return [_with_modes(r, knots, modes) for r in records]


def _window(at: FloatArray, knots: FloatArray) -> FloatArray:
    """Return the weights of a Gaussian window about each knot, shape (knots, n)."""
    width = 0.25 * WINDOW * (knots[-1] - knots[0])
    weights = functions.exp(-0.5 * (np.subtract.outer(knots, at) / width) ** 2)
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _left(window: FloatArray, sd: FloatArray, correlation: Correlation) -> FloatArray:
    """Return the variance that the noise of the points leaves at the knots, shape (knots,)."""
    weighted = window * sd
    r = correlation.sequence(window.shape[1])
    total = np.sum(weighted**2, axis=1)
    for lag in range(1, window.shape[1]):
        if abs(r[lag]) < 1e-3:
            break
        total += 2.0 * r[lag] * np.sum(weighted[:, lag:] * weighted[:, :-lag], axis=1)
    return np.asarray(np.maximum(total, 0.0))


def _significant(variance: FloatArray, left: FloatArray, freedom: int) -> bool:
    """Tell whether the scatter is more than the noise of the points makes of itself."""
    # A smoothed record has about 1 / WINDOW independent values, each of them a variance with
    # ``freedom`` degrees of freedom: the mean ratio scatters by sqrt(2 WINDOW / freedom).
    ratio = float(np.mean(variance / np.maximum(left, 1e-300)))
    return ratio > 1.0 + SIGNIFICANT * float(np.sqrt(2.0 * WINDOW / freedom))


def _modes(knots: FloatArray, shown: FloatArray, tau: FloatArray) -> FloatArray:
    """Return U of K = U U^T at the knots, shape (knots, modes)."""
    freedom = len(shown) - 1
    span = LASTING * (knots[-1] - knots[0])
    lasting = linear.cholesky(functions.exp(-np.abs(np.subtract.outer(knots, knots)) / span))
    both = np.column_stack([shown.T / np.sqrt(freedom), tau[:, None] * lasting])
    return student_factor(freedom) * both


def student_factor(freedom: int) -> float:
    """Return the quantile of Student's distribution at 97.5 % over that of the normal one.

    >>> round(student_factor(2), 2)
    2.2
    """
    return float(stdtrit(freedom, 0.975)) / QUANTILE


def _with_modes(record: _Record, knots: FloatArray, modes: FloatArray) -> NoiseModel:
    own = np.column_stack([np.interp(record.at, knots, mode) for mode in modes.T])
    size = float(np.median(np.sqrt(np.sum(own**2, axis=1))))
    noise = record.noise
    return replace(noise, modes=own, floors={**noise.floors, FLOOR: size})


def _aligned(
    grid: FloatArray, values: FloatArray, window: FloatArray, knots: FloatArray
) -> FloatArray:
    """Return the deviations that remain once amplitude, stretch and start are fitted.

    y_r(t) = y_0 + a (m((t - d)/b) - y_0) is fitted to each smoothed record by least squares. The
    mean m of all is made anew from the records with their own a, b, d taken out.
    """
    smooth = linear.product(values, window.T)
    mean, middle = smooth.mean(axis=0), values.mean(axis=0)
    for _ in range(2):
        fits = [_warp(knots, mean, record) for record in smooth]
        mean, middle = (
            np.mean([_straight(at, y, p) for y, p in zip(of, fits, strict=True)], axis=0)
            for at, of in ((knots, smooth), (grid, values))
        )
    ends = [_warp(knots, mean, record) for record in smooth]
    return np.array([y - _warped(grid, middle, p) for y, p in zip(values, ends, strict=True)])


def _warp(knots: FloatArray, mean: FloatArray, record: FloatArray) -> FloatArray:
    """Return amplitude, stretch and start (over the record's length) of a record."""
    scale = max(float(np.ptp(mean)), 1e-300)
    start = np.array([1.0, 1.0, 0.0])
    return fitting.least_squares(lambda p: (_warped(knots, mean, p) - record) / scale, start)


def _warped(at: FloatArray, mean: FloatArray, fit: FloatArray) -> FloatArray:
    amplitude, stretch, start = fit
    own = at[0] + (at - at[0] - start * (at[-1] - at[0])) / max(stretch, 0.1)
    return np.asarray(mean[0] + amplitude * (np.interp(own, at, mean) - mean[0]))


def _straight(at: FloatArray, record: FloatArray, fit: FloatArray) -> FloatArray:
    """Return a record with its own amplitude, stretch and start taken out."""
    amplitude, stretch, start = fit
    own = at[0] + (at - at[0]) * stretch + start * (at[-1] - at[0])
    moved = np.interp(own, at, record)
    return np.asarray(moved[0] + (moved - moved[0]) / amplitude)
