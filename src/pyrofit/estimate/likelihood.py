"""The likelihood of a parameter set: whitened residuals of all channels, and their optimum."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.estimate.between_repeats import with_repeats
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.prior import NO_PRIOR, NormalPrior
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray

STEP = 2e-3
"""Half the distance of a central difference, as a fraction of the limits' distance. From 1e-4 to
5e-3 no standard deviation changes by 0.3 %: neither solver noise nor curvature shows."""
MOST_STEPS = 40
MOST_DAMPING = 1e6
PRIOR = 1e-6
"""Added to the curvature, so that what the data say nothing about does not move."""
ENOUGH = 1e-3
"""A step that lowers chi-square by less is the last one; 3.84 bounds a 95 % interval."""
DESCENTS = 4
"""Starts that are followed."""
APART = 0.02
"""Starts nearer than this fraction of the limits in every parameter count as one."""
FAILED = 1e4
"""Whitened residual of a run that did not finish: worse than that of any run that did."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """Where chi-square is least: x in [0, 1] of the limits' distance, shape (parameters,)."""

    chi2: float
    x: FloatArray


@dataclass(frozen=True, eq=False)
class Likelihood:
    """chi2(x) = sum over channels of |L^-1 (model(x) - y) / sd|^2 + |(x_k - mean) / sd_k|^2.

    This is -2 log likelihood + constant, known parameters x_k included.

    Parameters
    ----------
    problem
        Its terms are the channels, each once, at their measured points.
    noise
        Noise of each channel.
    prior
        What is known of parameters.
    """

    problem: Problem
    noise: tuple[NoiseModel, ...]
    prior: NormalPrior = NO_PRIOR

    @property
    def points(self) -> list[int]:
        """Number of points of each channel."""
        return [noise.sd.size for noise in self.noise]

    def values(self, x: FloatArray) -> FloatArray:
        """Return the parameters in SI units."""
        return self.problem.lower + x * (self.problem.upper - self.problem.lower)

    def scaled(self, values: FloatArray) -> FloatArray:
        """Return SI values as fractions of the limits' distance, brought within the limits."""
        span = self.problem.upper - self.problem.lower
        return np.clip((values - self.problem.lower) / span, 0.0, 1.0)

    def curves(self, x: FloatArray) -> FloatArray | None:
        """Return the simulated channels one after the other; None where a run does not finish."""
        return self.curves_all(x[None])[0]

    def curves_all(self, X: FloatArray) -> list[FloatArray | None]:
        """Return the same for several sets at once, shape (sets, parameters)."""
        outcomes = self.problem.simulate_all(self.values(X))
        return [np.concatenate(models) if status.finished else None for status, models in outcomes]

    def split(self, stacked: FloatArray) -> list[FloatArray]:
        """Return what belongs to each channel of (points,) or (points, k).

        Rows behind the points, of what is known, are left out.
        """
        ends = np.cumsum(self.points)
        return np.split(stacked[: ends[-1]], ends[:-1])

    def whiten(self, stacked: FloatArray) -> FloatArray:
        """Whiten each channel of (points,) or (points, k)."""
        parts = zip(self.noise, self.split(stacked), strict=True)
        return np.concatenate([noise.whiten(part) for noise, part in parts])

    def residuals(self, x: FloatArray) -> FloatArray:
        """Return the whitened residuals of all channels, then those of what is known.

        The shape is (points + known,).
        """
        return self.residuals_all(x[None])[0]

    def residuals_all(self, X: FloatArray) -> list[FloatArray]:
        """Return the same for several sets at once, shape (sets, parameters)."""
        channels = [self._of_channels(curves) for curves in self.curves_all(X)]
        known = self.prior.residuals(self.values(X))
        return [np.concatenate(both) for both in zip(channels, known, strict=True)]

    def _of_channels(self, curves: FloatArray | None) -> FloatArray:
        if curves is None or not np.all(np.isfinite(curves)):
            return np.full(sum(self.points), FAILED)
        measured = np.concatenate([term.target.value for _, term in self.problem.cost.terms])
        return self.whiten(curves - measured)

    def chi2(self, x: FloatArray) -> float:
        """Return the sum of the squares of the whitened residuals."""
        residuals = self.residuals(x)
        return float(residuals @ residuals)

    def slopes(
        self, x: FloatArray, index: Sequence[int] | None = None, step: float = STEP
    ) -> FloatArray:
        """Return d curves / d x per limits' distance, shape (points, parameters).

        Differences of second order: central, or of three points on one side at a limit. ``index``
        picks the parameters; default all. Zero where a run does not finish.
        """
        chosen = range(x.size) if index is None else index
        moves = [_moves(x[i], step) for i in chosen]
        moved = [_moved(x, i, by) for i, m in zip(chosen, moves, strict=True) for by in m]
        curves = iter(self.curves_all(np.array(moved).reshape(-1, x.size)))
        columns = []
        for weights in moves:
            there = [c for c in (next(curves) for _ in weights) if c is not None]
            column = np.zeros(sum(self.points))
            if len(there) == len(weights):
                for weight, curve in zip(weights.values(), there, strict=True):
                    column += weight * curve
            columns.append(column)
        return np.column_stack(columns)

    def jacobian(
        self, x: FloatArray, index: Sequence[int] | None = None, step: float = STEP
    ) -> FloatArray:
        """Return d residuals / d x: the whitened `slopes`, then those of what is known."""
        return self.with_known(self.slopes(x, index, step), index)

    def with_known(self, slopes: FloatArray, index: Sequence[int] | None = None) -> FloatArray:
        """Return d residuals / d x from d curves / d x of some parameters, default all."""
        known = self.prior.slopes(self.problem.upper - self.problem.lower)
        return np.vstack([self.whiten(slopes), known if index is None else known[:, list(index)]])

    def descend(self, x: FloatArray, fixed: int | None = None) -> Optimum:
        """Minimise chi-square from x by Levenberg and Marquardt's method within the limits.

        Marquardt (1963, doi 10.1137/0111030). A parameter at a limit that chi-square pushes
        outwards rests there for the step; parameter ``fixed`` keeps its value.
        """
        index = [i for i in range(x.size) if i != fixed]
        residuals = self.residuals(x)
        damping = 1e-3
        for _ in range(MOST_STEPS if index else 0):
            J = self.jacobian(x, index)
            slope = J.T @ residuals
            free = _free(x[index], slope)
            before = float(residuals @ residuals)
            x, residuals, damping = self._step(
                x, residuals, J[:, free], slope[free], np.array(index)[free], damping
            )
            if before - float(residuals @ residuals) < ENOUGH:
                break
        return Optimum(float(residuals @ residuals), x)

    def _step(
        self,
        x: FloatArray,
        residuals: FloatArray,
        J: FloatArray,
        slope: FloatArray,
        where: FloatArray,
        damping: float,
    ) -> tuple[FloatArray, FloatArray, float]:
        """Return x, residuals and damping after a step that lowers chi-square, if there is one."""
        bend = J.T @ J
        while damping < MOST_DAMPING and where.size:
            damped = bend + np.diag(damping * np.diag(bend) + PRIOR)
            trial = x.copy()
            trial[where] = np.clip(x[where] - np.linalg.solve(damped, slope), 0.0, 1.0)
            there = self.residuals(trial)
            if there @ there < residuals @ residuals:
                return trial, there, max(0.1 * damping, 1e-7)
            damping *= 10.0
        return x, residuals, damping


def _free(x: FloatArray, slope: FloatArray) -> FloatArray:
    """Tell which parameters are not pushed out of the limits."""
    return np.asarray(~((x <= 0.0) & (slope > 0.0)) & ~((x >= 1.0) & (slope < 0.0)))


def _moves(x: float, step: float) -> dict[float, float]:
    """Return how far to move a parameter, and the weights of the curves there in its slope."""
    if step <= x <= 1.0 - step:
        return {step: 0.5 / step, -step: -0.5 / step}
    inward = step if x < 0.5 else -step
    return {0.0: -1.5 / inward, inward: 2.0 / inward, 2.0 * inward: -0.5 / inward}


def _moved(x: FloatArray, i: int, by: float) -> FloatArray:
    moved = x.copy()
    moved[i] += by
    return moved


def likelihood_of(problem: Problem, prior: NormalPrior = NO_PRIOR) -> Likelihood:
    """Return the likelihood of a problem whose terms are channels, with their noise estimated.

    ``prior`` is what is known of its parameters.

    Raises
    ------
    DataError
        A channel is too short.
    """
    noise = [noise_of(problem, channel) for channel in range(len(problem.picks))]
    return Likelihood(problem, with_repeats(problem, noise), prior)


def fit(likelihood: Likelihood, starts: Sequence[FloatArray]) -> Optimum:
    """Descend from the best of several scaled starts that differ; return the lowest end."""
    chosen: list[FloatArray] = []
    ahead = [float(r @ r) for r in likelihood.residuals_all(np.array(starts))]
    for _, x in sorted(zip(ahead, starts, strict=True), key=lambda pair: pair[0]):
        if all(np.max(np.abs(x - other)) > APART for other in chosen):
            chosen.append(x)
    ends = [likelihood.descend(x) for x in chosen[:DESCENTS]]
    return min(ends, key=lambda end: end.chi2)
