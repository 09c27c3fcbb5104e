"""Where model and measurement disagree, at a controlled level of false alarm.

For a window of L of a channel's n whitened residuals w the statistic is
|sum w|/sqrt(L) - sqrt(2 log(n/L)): short windows, of which there are many, must stand out more
(Duembgen and Spokoiny 2001, doi 10.1214/aos/996986504). Its critical value is that of the noise
itself, projected as the fit projects it. Where the largest is above, its window is noted and both
sides are searched on, as in narrowest-significance pursuit (Fryzlewicz 2024,
doi 10.1080/01621459.2023.2211733).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2 as chi_squared

from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.model import Model
from pyrofit.diagnose.base.projection import project, projector
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.numerics import functions, linear
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True)
class Stretch:
    """Points ``start`` to ``end`` (excluded) of a channel that are off to one side."""

    channel: int
    start: int
    end: int
    statistic: float
    sign: int


@dataclass(frozen=True, eq=False)
class LackOfFit:
    """The residuals of a fit, against those of noise alone."""

    windows: tuple[Stretch, ...]
    scan: float
    scan_critical: float
    score: float
    score_critical: float
    chi2: float
    chi2_critical: float

    @property
    def adequate(self) -> bool:
        """Whether the scan and chi-square find nothing that noise would not leave."""
        return not self.windows and self.chi2 <= self.chi2_critical

    @property
    def passes(self) -> bool:
        """Whether no effect's score is remarkable either."""
        return self.adequate and self.score <= self.score_critical


def lack_of_fit(
    model: Model,
    fit: Fit,
    directions: Sequence[FloatArray],
    rng: np.random.Generator,
    processes: int = 1,
) -> LackOfFit:
    """Compare the residuals of a fit with draws of the noise, projected as the fit projects it.

    ``directions`` holds the unit changes by each candidate, shape (points + known, strengths).
    """
    spanned = projector(fit)

    def critical_values(blocks: int) -> tuple[float, float]:
        rngs = rng.spawn(blocks)
        drawn = parallel_map(
            lambda b: _of_noise(model, spanned, directions, rngs[b]), blocks, processes
        )
        scans, scores = (np.concatenate(of_blocks) for of_blocks in zip(*drawn, strict=True))
        level = 1.0 - SETTINGS.false_alarm_level
        return float(np.quantile(scans, level)), float(np.quantile(scores, level))

    parts = model.by_channel(fit.residuals)
    scan = float(max(_highest(part[:, None])[0] for part in parts))
    critical, score_critical = critical_values(SETTINGS.draw_blocks)
    if abs(scan - critical) < SETTINGS.close_scan:
        critical, score_critical = critical_values(SETTINGS.close_draw_blocks)
    freedom = fit.residuals.size - float(np.sum(spanned**2))
    windows = [w for i, part in enumerate(parts) for w in windows_of(part, critical, i)]
    return LackOfFit(
        windows=tuple(windows),
        scan=scan,
        scan_critical=critical,
        score=max((score(fit.residuals, d) for d in directions), default=0.0),
        score_critical=score_critical,
        chi2=fit.chi2,
        chi2_critical=float(chi_squared.isf(SETTINGS.false_alarm_level, freedom)),
    )


def _of_noise(
    model: Model,
    spanned: FloatArray,
    directions: Sequence[FloatArray],
    rng: np.random.Generator,
) -> tuple[FloatArray, FloatArray]:
    """Return the largest scan statistic and the largest score of each of some draws of noise."""
    draws = SETTINGS.draws_per_block
    noise = project(spanned, rng.standard_normal((spanned.shape[0], draws)))
    scans = [_highest(part) for part in model.by_channel(noise)]
    scores = [-(linear.product(noise.T, d)).min(axis=1, initial=0.0) for d in directions]
    return np.max(scans, axis=0), np.max([np.zeros(draws), *scores], axis=0)


def score(residuals: FloatArray, directions: FloatArray) -> float:
    """Return the largest score of the residuals along unit changes, zero at least."""
    scores = -(linear.product(residuals, directions))
    return float(scores.max(initial=0.0))


def windows_of(w: FloatArray, critical: float, channel: int = 0) -> list[Stretch]:
    """Return the windows of a channel above the critical value, in order of time."""
    found: list[Stretch] = []
    waiting = [(0, w.size)]
    while waiting and len(found) < SETTINGS.most_windows:
        low, high = waiting.pop(0)
        best = _best(w, low, high)
        if best is None or best[0] <= critical:
            continue
        value, start, end = best
        sign = 1 if w[start:end].sum() > 0.0 else -1
        found.append(Stretch(channel, start, end, value, sign))
        waiting += [(low, start), (end, high)]
    return sorted(found, key=lambda window: window.start)


def _best(w: FloatArray, low: int, high: int) -> tuple[float, int, int] | None:
    """Return statistic, start and end of the window that stands out most."""
    best = None
    total = np.concatenate([[0.0], np.cumsum(w[low:high])])
    for length in _lengths(high - low):
        sums = np.abs(total[length:] - total[:-length]) / np.sqrt(length)
        at = int(sums.argmax())
        value = float(sums[at]) - _handicap(w.size, length)
        if best is None or value > best[0]:
            best = value, low + at, low + at + length
    return best


def _highest(w: FloatArray) -> FloatArray:
    """Return the largest statistic of each column of (points, draws)."""
    total = np.concatenate([np.zeros((1, w.shape[1])), np.cumsum(w, axis=0)])
    found = np.full(w.shape[1], -np.inf)
    for length in _lengths(len(w)):
        sums = np.abs(total[length:] - total[:-length]).max(axis=0) / np.sqrt(length)
        found = np.maximum(found, sums - _handicap(len(w), length))
    return found


def _lengths(points: int) -> list[int]:
    """Return lengths of windows, each about sqrt(2) times the one before.

    >>> _lengths(12)
    [1, 2, 3, 4, 6, 8, 11]
    """
    found, k = [], 0
    while (length := round(2.0 ** (0.5 * k))) <= points:
        found += [length, 3] if length == 2 and points > 2 else [length]
        k += 1
    return list(dict.fromkeys(found))


def _handicap(points: int, length: int) -> float:
    return float(np.sqrt(2.0 * functions.log(points / length)))
