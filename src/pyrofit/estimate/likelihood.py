"""The likelihood of a parameter set: whitened residuals of all channels, and their optimum."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from pyrofit.estimate.between_ends import with_records
from pyrofit.estimate.bounded_least_squares import Fit, minimise
from pyrofit.estimate.channel_noise import noise_of
from pyrofit.estimate.derivatives import derivatives
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.posterior import Posterior
from pyrofit.estimate.prior import NO_PRIOR, NormalPrior
from pyrofit.estimate.problem import Problem
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

ENOUGH = 1e-4
"""A descent ends where the next step promises less of chi-square; 3.84 bounds a 95 % interval."""
DESCENTS = 4
"""Starts that are followed."""
APART = 0.02
"""Starts nearer than this fraction of the search range in every parameter count as one."""
FAILED = 1e4
"""Whitened residual of a run that did not finish: worse than that of any run that did."""


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
        Known values of parameters.
    """

    problem: Problem
    noise: tuple[NoiseModel, ...]
    prior: NormalPrior = NO_PRIOR

    @property
    def cautious(self) -> "Likelihood":
        """The likelihood with all errors that few repeats may hide in the noise."""
        return replace(self, noise=tuple(noise.cautious for noise in self.noise))

    def posterior(self, x: FloatArray, slopes: FloatArray) -> Posterior:
        """Return the parameters about an optimum x, from d curves / d x there."""
        J = self.with_known(slopes)
        found = Posterior(x, self.residuals(x)[: sum(self.points)], J)
        return replace(found, hidden=self._hidden(J))

    def _hidden(self, jacobian: FloatArray) -> FloatArray | None:
        """Return V^T J of the whitened errors V that few repeats may hide."""
        pairs = zip(self.noise, self.split(jacobian), strict=True)
        rows = [
            linear.product(noise.whiten(noise.hidden).T, part)
            for noise, part in pairs
            if noise.hidden is not None
        ]
        return np.vstack(rows) if rows else None

    @property
    def points(self) -> list[int]:
        """Number of points of each channel."""
        return [noise.sd.size for noise in self.noise]

    def values(self, x: FloatArray) -> FloatArray:
        """Return the parameters in SI units."""
        return self.problem.lower + x * self.problem.span

    def scaled(self, values: FloatArray) -> FloatArray:
        """Return SI values as fractions of the search range, brought within the limits."""
        return np.clip((values - self.problem.lower) / self.problem.span, 0.0, 1.0)

    def curves(self, x: FloatArray) -> FloatArray | None:
        """Return the simulated channels one after the other; None where a run does not finish."""
        return self.curves_all(x[None])[0]

    def curves_all(self, X: FloatArray, led: bool = False) -> list[FloatArray | None]:
        """Return the simulated channels of several sets, X of shape (sets, parameters).

        They stand one after the other; None where a run does not finish. The sets may be ``led`` by
        the first one, see `Problem.simulate_all`.
        """
        outcomes = self.problem.simulate_all(self.values(X), led)
        found = [np.concatenate(models) if status.finished else None for status, models in outcomes]
        return [None if c is None or not np.all(np.isfinite(c)) else c for c in found]

    def split(self, stacked: FloatArray) -> list[FloatArray]:
        """Return the part of each channel of (points,) or (points, k).

        Rows behind the points, of the known values, are left out.
        """
        return [stacked[a:b] for a, b in self._ranges]

    @cached_property
    def _ranges(self) -> list[tuple[int, int]]:
        """Where each channel begins and ends."""
        return list(pairwise([0, *np.cumsum(self.points).tolist()]))

    def whiten(self, stacked: FloatArray) -> FloatArray:
        """Whiten each channel of (points,) or (points, k)."""
        return np.concatenate(self._whitened(stacked))

    def _whitened(self, stacked: FloatArray) -> list[FloatArray]:
        parts = zip(self.noise, self.split(stacked), strict=True)
        return [noise.whiten(part) for noise, part in parts]

    def residuals(self, x: FloatArray) -> FloatArray:
        """Return the whitened residuals of all channels, then those of the known values.

        The shape is (points + known,).
        """
        return self.residuals_all(x[None])[0]

    def residuals_all(self, X: FloatArray, led: bool = False) -> list[FloatArray]:
        """Return the whitened residuals of several sets, X of shape (sets, parameters).

        Each is of shape (points + known,), as those of `residuals`. The sets may be ``led`` by the
        first one, see `Problem.simulate_all`.
        """
        channels = [self._of_channels(curves) for curves in self.curves_all(X, led)]
        known = self.prior.residuals(self.values(X))
        return [np.concatenate([*parts, own]) for parts, own in zip(channels, known, strict=True)]

    def _of_channels(self, curves: FloatArray | None) -> list[FloatArray]:
        if curves is None:
            return [np.full(sum(self.points), FAILED)]
        return self._whitened(curves - self._measured)

    @cached_property
    def _measured(self) -> FloatArray:
        return np.concatenate([term.target.value for _, term in self.problem.cost.terms])

    def chi2(self, x: FloatArray) -> float:
        """Return the sum of the squares of the whitened residuals."""
        residuals = self.residuals(x)
        return linear.dot(residuals, residuals)

    def finished(self, residuals: FloatArray) -> bool:
        """Tell whether all runs finished that some residuals come from."""
        return not bool(np.all(residuals[: sum(self.points)] == FAILED))

    def slopes(self, x: FloatArray) -> FloatArray:
        """Return d curves / d x per search range, shape (points, parameters).

        They are zero where no run beside x finishes, or the one at x does not.
        """
        here = self.curves(x)
        if here is None:
            return np.zeros((sum(self.points), x.size))
        beside = partial(self.curves_all, led=True)
        problem = self.problem
        return derivatives(beside, x, here, problem.difference, problem.moving)[0]

    def jacobian(self, x: FloatArray, residuals: FloatArray) -> FloatArray:
        """Return d residuals / d x, from the residuals at x; zero where no run beside it finishes.

        The shape is (points + known, parameters).
        """

        def beside(X: FloatArray) -> list[FloatArray | None]:
            found = self.residuals_all(X, led=True)
            return [there if self.finished(there) else None for there in found]

        problem = self.problem
        J = derivatives(beside, x, residuals, problem.difference, problem.moving)[0]
        idle = list(problem.idle)
        J[sum(self.points) :, idle] = self.prior.slopes(problem.span)[:, idle]
        return J

    def with_known(self, slopes: FloatArray) -> FloatArray:
        """Return d residuals / d x from d curves / d x."""
        known = self.prior.slopes(self.problem.span)
        return np.vstack([self.whiten(slopes), known])

    def with_idle_known(self, x: FloatArray, fixed: int | None = None) -> FloatArray:
        """Return x with known values of parameters that no run uses; ``fixed`` keeps its value."""
        x, idle = x.copy(), self.problem.idle
        for i, mean in zip(self.prior.index, self.prior.mean, strict=True):
            if i in idle and i != fixed:
                x[i] = (mean - self.problem.lower[i]) / self.problem.span[i]
        return x

    def descend(self, x: FloatArray, fixed: int | None = None) -> Fit:
        """Minimise chi-square from x within the limits; parameter ``fixed`` keeps its value."""
        x, idle = self.with_idle_known(x, fixed), self.problem.idle
        return minimise(self.residuals, self.jacobian, x, ENOUGH, fixed=fixed, idle=idle)


def likelihood_of(
    problem: Problem, prior: NormalPrior = NO_PRIOR, tolerant: bool = False
) -> Likelihood:
    """Return the likelihood of a problem whose terms are channels, with their noise estimated.

    ``prior`` holds the known values of its parameters. A ``tolerant`` noise includes the usual
    discrepancy of models, and errors that few repeats may hide.

    Raises
    ------
    DataError
        A channel is too short.
    """
    noise = [noise_of(problem, channel, tolerant=tolerant) for channel in range(len(problem.picks))]
    found = Likelihood(problem, with_records(problem, noise), prior)
    return found.cautious if tolerant else found


def fit(likelihood: Likelihood, starts: Sequence[FloatArray]) -> Fit:
    """Descend from the best of several scaled starts that differ; return the lowest end."""
    return descents(likelihood, starts)[0]


def descents(likelihood: Likelihood, starts: Sequence[FloatArray]) -> list[Fit]:
    """Return the ends of these descents, the lowest chi-square first."""
    chosen: list[FloatArray] = []
    ahead = [linear.dot(r, r) for r in likelihood.residuals_all(np.array(starts))]
    for _, x in sorted(zip(ahead, starts, strict=True), key=lambda pair: pair[0]):
        if all(np.max(np.abs(x - other)) > APART for other in chosen):
            chosen.append(x)
    ends = [likelihood.descend(x) for x in chosen[:DESCENTS]]
    return sorted(ends, key=lambda end: end.chi2)
