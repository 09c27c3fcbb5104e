"""The scatter between repeats of a test, as a lasting part of their noise.

Repeat r of R records y_r = f + u_r + e_r: a curve f that all share, a random effect u_r that lasts
over the record, and noise e_r of its points. With d_r = y_r - mean and W a window that smooths over
time as that of a stated uncertainty does, variance between repeats and covariance of u_r are

    tau^2 = (W (sum_r d_r^2 - (R - 1) variance of e) + n_0 sum_k g_k^2) / (n_0 + R - 1),
    K = a (S S^T + n_0 sum_k g_k g_k^T) / (n_0 + R - 1) + (1 - a) tau tau^T * exp(-|t - t'| / l),

S = W (d_1 ... d_R). The usual changes g_k of their mean, by level, stretch and start, count as n_0
further repeats. They have c times their usual size, as careful laboratories differ less in all:

    c^2 = (n_0 U + E) / ((n_0 + R - 1) U),    U = sum_k |usual g_k|^2,    E = |S|^2 - that of e.

The share a of K is the covariance of the repeats. It lasts over the whole record,
so that a parameter that moves the curve alike is uncertain by as much. The rest has the same size
in all other directions, of which few repeats show only few.

Few repeats tell their own scatter badly. This is no reason to weigh them less, but to trust the
result less. Intervals and tests of a fit therefore have q times both parts of K, each with its full
variance, and q = (t_(n_0 + R - 1) / 1.96)^2 from the quantiles of Student's and a normal
distribution.

Where fitted curves are known, d_r are the deviations from these, so that described differences do
not count. Where parameters describe how repeats differ, n_0 is 0; without fitted curves, d_r are
then the deviations that remain once level, stretch and start are fitted to each.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import stdtrit

from pyrofit.constants import QUANTILE
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import FEWEST_POINTS, REPEATS, NoiseModel
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.repeats_agree import is_held
from pyrofit.estimate.warp import NONE, changed, fitted, unchanged
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

WINDOW = 0.2
"""Window of the smoothing, as a fraction of the record: twice that of a stated uncertainty, as a
further repeat may be steep a little before or after those that are there."""
KNOTS = 81
"""Knots of a record."""
LASTING = 0.05
"""Time l over which the rest lasts, as a fraction of the record."""
SEEN = 0.9
"""a, the share of the variance in the directions that repeats show."""
USUAL_WEIGHT = 0.5
"""n_0, repeats that the usual values count as. Laboratories differ in theirs by factors."""
USUAL = (0.04, 0.04, 0.005)
"""s_0 of level and stretch, and of the start over the length of the record. Medians of the heat
release rates of 38 tests of the MaCFP data base: 0.041, 0.046, 0.004."""
USUAL_HEATED = (0.01, 0.002, 0.003)
"""The same of a heated sample: residue, heating rate, and temperature over the recorded range."""
USUAL_HELD = (0.01, 0.04, 0.005)
"""The same at a held temperature: an error of 1 K there stretches a record by 4 to 7 %."""
SIGNIFICANT = 2.0
"""Standard deviations by which the scatter must exceed the smoothed noise of the points."""


@dataclass(frozen=True)
class RepeatRecord:
    """One repeat: abscissa (time or temperature), values, fitted curve and noise, shape (n,)."""

    at: FloatArray
    value: FloatArray
    about: FloatArray | None
    noise: NoiseModel
    usual: tuple[float, float, float]
    """Usual changes by level, stretch and start."""

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

    It takes the place of one that the noise has already. Described differences do not count where
    fitted curves ``about`` are given. Where parameters describe them and there are no curves, the
    scatter between the aligned records counts.
    """
    found = [own.alone for own in noise]
    for channels in _groups(problem):
        records = [record_of(problem, i, found[i], about) for i in channels]
        free = _are_described(problem, channels)
        for i, model in zip(channels, _of_group(records, free), strict=True):
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


def groups_of_repeats(problem: Problem) -> Iterator[list[int]]:
    """Yield the positions of channels that repeat one signal, if no parameter stands for it."""
    yield from (group for group in _groups(problem) if not _are_described(problem, group))


def _are_described(problem: Problem, channels: Sequence[int]) -> bool:
    """Tell whether parameters describe how repeats differ."""
    repeats = [problem.runs[problem.picks[i][0]].experiment.repeat for i in channels]
    return any(name in problem.names for r in repeats if r for name in r.nuisances.values())


def record_of(
    problem: Problem, channel: int, noise: NoiseModel, about: Sequence[FloatArray] | None
) -> RepeatRecord:
    """Return a repeat, with the fitted curve where those of all channels are given."""
    target = problem.cost.terms[channel][1].target
    temperature = problem.temperature_K(channel)
    held = temperature is not None and is_held(temperature, target.value)
    at = target.time_s if temperature is None or held else temperature
    sizes = USUAL_HELD if held else USUAL if temperature is None else USUAL_HEATED
    curve = None if about is None else about[channel]
    return RepeatRecord(at, target.value, curve, noise, sizes)


def _of_group(records: Sequence[RepeatRecord], free: bool) -> list[NoiseModel]:
    """Return the noise of repeats; ``free``: parameters describe how they differ."""
    low = max(float(r.at.min()) for r in records)
    high = min(float(r.at.max()) for r in records)
    first = records[0].at
    grid = first[(first >= low) & (first <= high)]
    if grid.size < FEWEST_POINTS:
        return [r.noise for r in records]
    knots = np.linspace(low, high, KNOTS)
    window = _window(grid, knots)
    values = np.array([np.interp(grid, r.at, r.value) for r in records])
    freedom = len(records) - 1
    straight = _straightened(grid, values, window, knots)
    raw = straight.left if free else values - values.mean(axis=0)
    fitted_curves = [r.about for r in records if r.about is not None]
    if fitted_curves:
        pairs = zip(records, fitted_curves, strict=True)
        off = np.array([np.interp(grid, r.at, r.value - curve) for r, curve in pairs])
        raw = off - off.mean(axis=0)
    shown = linear.product(raw, window.T)
    left = np.mean([_left(_window(r.at, knots), *r.points) for r in records], axis=0)
    # Two records may agree by chance; a third rarely does.
    if (free or freedom > 1) and not _significant(
        np.sum(shown**2, axis=0) / freedom, left, freedom
    ):
        return [r.noise for r in records]
    of_points = np.mean([np.interp(grid, r.at, r.points[0] ** 2) for r in records], axis=0)
    usual = np.zeros((0, KNOTS))
    if not free:
        usual = usual_changes(knots, straight.mean, records[0].usual)
        usual *= np.sqrt(USUAL_WEIGHT) * _care(usual, shown, freedom * left)
    total = freedom + (0.0 if free else USUAL_WEIGHT)
    smooth = linear.product(window, np.sum(raw**2, axis=0) - freedom * of_points)
    tau = np.sqrt(np.maximum(smooth, 0.0) + np.sum(usual**2, axis=0))
    span = LASTING * (knots[-1] - knots[0])
    lasting = linear.cholesky(functions.exp(-np.abs(np.subtract.outer(knots, knots)) / span))
    seen = np.column_stack([usual.T, shown.T])
    every = [np.sqrt(SEEN) * seen, np.sqrt(1.0 - SEEN) * tau[:, None] * lasting]
    modes = np.column_stack(every) / np.sqrt(total)
    shares = np.repeat([SEEN, 1.0 - SEEN], [part.shape[1] for part in every])
    return [_with_modes(r, knots, modes, student_factor(total) / np.sqrt(shares)) for r in records]


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


def usual_changes(knots: FloatArray, mean: FloatArray, sizes: tuple[float, ...]) -> FloatArray:
    """Return the changes of the mean by the usual level, stretch and start, shape (3, knots)."""
    return np.array(
        [
            0.5 * (changed(knots, mean, NONE + step) - changed(knots, mean, NONE - step))
            for step in np.diag(sizes)
        ]
    )


def _care(usual: FloatArray, shown: FloatArray, left: FloatArray) -> float:
    """Return c, the scatter of repeats over the usual one.

    Parameters
    ----------
    usual
        Changes of their mean by the usual level, stretch and start, shape (3, knots).
    shown
        Smoothed deviations, shape (repeats, knots).
    left
        Squares of these by the noise of the points alone, shape (knots,).
    """
    squares = max(float(np.sum(usual**2)), 1e-300)
    excess = max(float(np.sum(shown**2)) - float(np.sum(left)), 0.0)
    told = len(shown) - 1
    return float(np.sqrt((USUAL_WEIGHT + excess / squares) / (USUAL_WEIGHT + told)))


def student_factor(freedom: float) -> float:
    """Return the quantile of Student's distribution at 97.5 % over that of the normal one.

    >>> round(student_factor(2), 2)
    2.2
    """
    return float(stdtrit(freedom, 0.975)) / QUANTILE


def _with_modes(
    record: RepeatRecord, knots: FloatArray, modes: FloatArray, caution: FloatArray
) -> NoiseModel:
    """Return the noise with modes, and the factors that intervals and tests take."""
    own = np.column_stack([np.interp(record.at, knots, mode) for mode in modes.T])
    return with_modes(record.noise, own, caution, REPEATS)


def with_modes(noise: NoiseModel, own: FloatArray, caution: FloatArray, name: str) -> NoiseModel:
    """Return a noise without scatter between records with modes of it, shape (n, modes)."""
    size = float(np.median(np.sqrt(np.sum(own**2, axis=1))))
    floors, between = {**noise.floors, name: size}, own.shape[1]
    if noise.modes is not None:
        own = np.column_stack([noise.modes, own])
        caution = np.concatenate([np.ones(noise.modes.shape[1]), caution])
    return replace(noise, modes=own, caution=caution, between=between, floors=floors)


@dataclass(frozen=True, eq=False)
class _Straightened:
    """Records made straight.

    Parameters
    ----------
    mean
        Their mean at the knots, shape (knots,).
    left
        Deviations that remain on the grid, shape (records, n).
    """

    mean: FloatArray
    left: FloatArray


def _straightened(
    grid: FloatArray, values: FloatArray, window: FloatArray, knots: FloatArray
) -> _Straightened:
    """Fit level, stretch and start of each smoothed record by least squares.

    The mean of all is made anew from the records with their own level, stretch and start taken out.
    """
    smooth = linear.product(values, window.T)
    mean, middle = smooth.mean(axis=0), values.mean(axis=0)
    for _ in range(2):
        fits = [fitted(knots, mean, record) for record in smooth]
        mean, middle = (
            np.mean([unchanged(at, y, p) for y, p in zip(of, fits, strict=True)], axis=0)
            for at, of in ((knots, smooth), (grid, values))
        )
    ends = [fitted(knots, mean, record) for record in smooth]
    left = np.array([y - changed(grid, middle, p) for y, p in zip(values, ends, strict=True)])
    return _Straightened(mean, left)
