"""Where model and measurement disagree, at a controlled level of false alarm.

The statistic is that of `pyrofit.estimate.scan`. Its critical value is that of the noise itself,
projected as the fit projects it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2 as chi_squared

from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.model import Model
from pyrofit.estimate.projection import project, projector
from pyrofit.estimate.scan import Stretch, highest, windows_of
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray


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
    settings, spanned = model.base.settings, projector(fit)

    def critical_values(blocks: int) -> tuple[float, float]:
        rngs = rng.spawn(blocks)
        drawn = parallel_map(
            lambda b: _of_noise(model, spanned, directions, rngs[b]), blocks, processes
        )
        scans, scores = (np.concatenate(of_blocks) for of_blocks in zip(*drawn, strict=True))
        level = 1.0 - settings.false_alarm_level
        return float(np.quantile(scans, level)), float(np.quantile(scores, level))

    parts = model.by_channel(fit.residuals)
    scan = float(max(highest(part[:, None])[0] for part in parts))
    critical, score_critical = critical_values(settings.draw_blocks)
    if abs(scan - critical) < settings.close_scan:
        critical, score_critical = critical_values(settings.close_draw_blocks)
    freedom = fit.residuals.size - model.absent - float(np.sum(spanned**2))
    most = settings.most_windows
    windows = [w for i, part in enumerate(parts) for w in windows_of(part, critical, i, most)]
    return LackOfFit(
        windows=tuple(windows),
        scan=scan,
        scan_critical=critical,
        score=max((score(fit.residuals, d) for d in directions), default=0.0),
        score_critical=score_critical,
        chi2=fit.chi2,
        chi2_critical=float(chi_squared.isf(settings.false_alarm_level, freedom)),
    )


def _of_noise(
    model: Model,
    spanned: FloatArray,
    directions: Sequence[FloatArray],
    rng: np.random.Generator,
) -> tuple[FloatArray, FloatArray]:
    """Return the largest scan statistic and the largest score of each of some draws of noise."""
    draws = model.base.settings.draws_per_block
    noise = project(spanned, rng.standard_normal((spanned.shape[0], draws)))
    scans = [highest(part) for part in model.by_channel(noise)]
    scores = [-(linear.product(noise.T, d)).min(axis=1, initial=0.0) for d in directions]
    return np.max(scans, axis=0), np.max([np.zeros(draws), *scores], axis=0)


def score(residuals: FloatArray, directions: FloatArray) -> float:
    """Return the largest score of the residuals along unit changes, zero at least."""
    scores = -(linear.product(residuals, directions))
    return float(scores.max(initial=0.0))
