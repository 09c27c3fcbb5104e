"""Model discrepancy as a random curve: its covariance, from the best fit's residuals.

y = f(x) + delta + e. A discrepancy (Kennedy and O'Hagan 2001, doi 10.1111/1467-9868.00294) is made
of relative errors of level and of time, and of an offset:

    delta(t) = a(t) (f - f_0) + b(t) t df/dt + c(t) range(f),
    cov(a, a') = s_a^2 exp(-(t - t')^2 / (2 (l t_half)^2)),  b and c likewise with s_b and s_c.

s_a, s_b, s_c and l have no unit; so they can be carried over to an experiment that was not fitted.
They have the highest restricted likelihood, which allows for the part of the residuals r that the
parameters absorb. With S = N + D, J = d f / d x, and known values as rows K, it is

    -2 log L = log det S + log det M + r^T S^-1 r - b^T M^-1 b,
    M = J^T S^-1 J + K^T K + 12 I,    b = J^T S^-1 r.

A smooth discrepancy looks much like a change of parameters: they absorb it, and residuals show
little of it. Expected values of s and l therefore count. Codes that are given one and the same
material differ by 3 to 5 % in time, and the best sets of the field miss the rate by 4 %.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.numerics import fitting, functions, linear
from pyrofit.solver.arrays import FloatArray

MOST_POINTS = 200
"""Points of a series from which a discrepancy is estimated, evenly taken: it lasts over many."""
USUAL = functions.log([0.03, 0.03, 0.01, 0.7])
"""Mean of the prior of s_a, s_b, s_c and l, as logarithms ..."""
SPREAD = np.array([1.0, 1.0, 1.0, 0.3])
"""... and its standard deviations."""
LIMITS = functions.log([[1e-5, 1e-5, 1e-5, 0.1], [0.5, 0.5, 0.5, 3.0]])
SWEEPS = 3
"""How often all channels are gone through."""
JITTER = 1e-10
"""Added to the diagonal, relative to the largest variance, so that a factor exists."""


@dataclass(frozen=True)
class Discrepancy:
    """Relative sizes of the errors of level and time and of the offset, and how long they last.

    ``lasting`` counts in half times of the curve: when half of all its ups and downs have passed.
    """

    level: float
    time: float
    offset: float
    lasting: float

    def covariance(self, time: FloatArray, curve: FloatArray) -> FloatArray:
        """Return D of a simulated curve at some times [s], shape (points, points)."""
        return linear.product(_basis(time, curve, self.lasting), self._squares)

    @property
    def _squares(self) -> FloatArray:
        return np.square([self.level, self.time, self.offset])

    def carried_to(
        self, time: FloatArray, curves: FloatArray, rng: np.random.Generator
    ) -> FloatArray:
        """Draw curves with discrepancy where there is no measurement, shape (sets, points).

        y(t) = f_0 + (1 + a) (f(t (1 + b)) - f_0) + c range(f): an error of time moves a steep end,
        and raises nothing above the curve.

        Parameters
        ----------
        time
            Times [s], shape (points,).
        curves
            f of each set, shape (sets, points).
        rng
            The random numbers.
        """
        middle = np.median(curves, axis=0)
        factor = factor_of(_kernel(time, middle, self.lasting))
        shape = (3, *curves.shape)
        drawn = linear.product(rng.standard_normal(shape), factor.T)
        a, b, c = drawn * np.sqrt(self._squares)[:, None, None]
        moved = np.array(
            [np.interp(time * (1.0 + s), time, f) for f, s in zip(curves, b, strict=True)]
        )
        first = curves[:, :1]
        return np.asarray(first + (1.0 + a) * (moved - first) + c * np.ptp(middle))

    def factor(self, time: FloatArray, curve: FloatArray) -> FloatArray:
        """Return F with F F^T = D but for `JITTER`, shape (points, few)."""
        shapes = _shapes(time, curve)
        scale = _scale(time, curve, self.lasting)

        def row(k: int) -> FloatArray:
            kernel = functions.exp(-0.5 * ((time - time[k]) / scale) ** 2)
            parts = [kernel * (shape[k] * shape) for shape in shapes]
            return linear.product(np.stack(parts, axis=1), self._squares)

        squares = np.stack([shape * shape for shape in shapes], axis=1)
        return linear.thin_factor(linear.product(squares, self._squares), row, JITTER)


def half_time(time: FloatArray, curve: FloatArray) -> float:
    """Return when half of all ups and downs of a curve have passed [s].

    >>> half_time(np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 1.0, 3.0, 4.0]))
    1.5
    """
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(curve)))])
    if way[-1] <= 0.0:
        return float(0.5 * time[-1])
    return float(np.interp(0.5 * way[-1], way, time))


def _scale(time: FloatArray, curve: FloatArray, lasting: float) -> float:
    return lasting * max(half_time(time, curve), 1e-9)


def _shapes(time: FloatArray, curve: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return curves that an error of level, of time, and an offset of size 1 add."""
    return (
        curve - curve[0],
        time * np.gradient(curve, time),
        np.full(curve.size, np.ptp(curve)),
    )


def _kernel(
    time: FloatArray, curve: FloatArray, lasting: float, few: slice = slice(None)
) -> FloatArray:
    scale = _scale(time, curve, lasting)
    at = time[few]
    return functions.exp(-0.5 * (np.subtract.outer(at, at) / scale) ** 2)


def _basis(
    time: FloatArray, curve: FloatArray, lasting: float, few: slice = slice(None)
) -> FloatArray:
    """Return the covariance of each part for a size of 1, at some points: (points, points, 3)."""
    kernel = _kernel(time, curve, lasting, few)
    parts = [kernel * np.outer(g, g) for g in (s[few] for s in _shapes(time, curve))]
    return np.asarray(np.stack(parts, axis=2))


def factor_of(covariance: FloatArray) -> FloatArray:
    """Return the Cholesky factor of a covariance that may be singular."""
    size = float(np.max(np.diag(covariance)))
    raised = covariance + (JITTER * size + 1e-300) * np.eye(len(covariance))
    return linear.cholesky(raised)


def noise_covariance(noise: NoiseModel, few: slice = slice(None)) -> FloatArray:
    """Return N of a channel at some of its points: with w = A r white, N = (A^T A)^-1."""
    points = noise.sd.size
    at, sd = np.arange(points)[few], noise.sd[few]
    apart = np.abs(np.subtract.outer(at, at))
    N = np.outer(sd, sd) * noise.correlation.sequence(points)[apart]
    return N if noise.modes is None else N + linear.gram(noise.modes[few].T)


def with_discrepancy(
    likelihood: Likelihood, found: Sequence[Discrepancy], curves: FloatArray
) -> Likelihood:
    """Return the likelihood with discrepancies of some simulated curves in its covariance."""
    widened = []
    for noise, of, time, curve in zip(
        likelihood.noise, found, times(likelihood), likelihood.split(curves), strict=True
    ):
        modes = of.factor(time, curve)
        noise = noise.cautious
        known = [] if noise.modes is None else [noise.modes]
        widened.append(replace(noise, modes=np.column_stack([*known, modes]), between=0))
    return replace(likelihood, noise=tuple(widened))


def times(likelihood: Likelihood) -> list[FloatArray]:
    """Return the times of each channel [s]."""
    return [term.target.time_s for _, term in likelihood.problem.cost.terms]


def estimated(
    likelihood: Likelihood,
    x: FloatArray,
    slopes: FloatArray,
    curves: FloatArray,
    most_points: int = MOST_POINTS,
) -> tuple[Discrepancy, ...]:
    """Estimate the discrepancy of each channel from the residuals at x.

    Parameters
    ----------
    likelihood
        With the noise alone.
    x
        Optimum, in units of the search range.
    slopes, curves
        d curves / d x and the curves there, shapes (points, parameters) and (points,).
    most_points
        Points of a series that are used.
    """
    measured = np.concatenate([t.target.value for _, t in likelihood.problem.cost.terms])
    parts = zip(
        likelihood.noise,
        times(likelihood),
        likelihood.split(curves),
        likelihood.split(slopes),
        likelihood.split(measured - curves),
        strict=True,
    )
    channels = [_Channel(*part, most_points) for part in parts]
    known = likelihood.prior.slopes(likelihood.problem.span)
    ahead = linear.gram(known) + UNIFORM * np.eye(x.size)
    logs = [USUAL.copy() for _ in channels]
    sums = [channel.sums(log) for channel, log in zip(channels, logs, strict=True)]
    for _ in range(SWEEPS):
        for k, channel in enumerate(channels):
            others = [own for i, own in enumerate(sums) if i != k]
            M = ahead + sum((own[0] for own in others), np.zeros_like(ahead))
            b = sum((own[1] for own in others), np.zeros(x.size))
            logs[k] = channel.likeliest(M, b, logs[k])
            sums[k] = channel.sums(logs[k])
    return tuple(Discrepancy(*functions.exp(log).tolist()) for log in logs)


Sums = tuple[FloatArray, FloatArray, float]
"""J^T S^-1 J, J^T S^-1 r, and r^T S^-1 r + log det S of a channel."""


class _Channel:
    """Residuals of a channel at few points, and their covariance."""

    def __init__(
        self,
        noise: NoiseModel,
        time: FloatArray,
        curve: FloatArray,
        slopes: FloatArray,
        residual: FloatArray,
        most_points: int,
    ) -> None:
        few = slice(None, None, max(1, -(-time.size // most_points)))
        self.noise = noise_covariance(noise, few)
        self.rows = np.column_stack([slopes, residual])[few]
        self.time, self.curve, self.few = time, curve, few
        self.bases: dict[float, FloatArray] = {}

    def _basis(self, lasting: float) -> FloatArray:
        return _basis(self.time, self.curve, lasting, self.few)

    def sums(self, log: FloatArray) -> Sums:
        """Return the sums for logarithms of sizes and lasting."""
        *sizes, lasting = functions.exp(log)
        S = self.noise + linear.product(self._basis(float(lasting)), np.square(sizes))
        factor = linear.cholesky(S)
        white = linear.solve_lower(factor, self.rows)
        J, r = white[:, :-1], white[:, -1]
        log_det = 2.0 * float(np.sum(functions.log(np.diag(factor))))
        return linear.gram(J), linear.product(J.T, r), linear.dot(r, r) + log_det

    def likeliest(self, M: FloatArray, b: FloatArray, start: FloatArray) -> FloatArray:
        """Return the logarithms of the highest restricted likelihood."""

        def criterion(log: FloatArray) -> float:
            inside = np.clip(log, *LIMITS)
            JJ, Jr, rr = self.sums(inside)
            whole, part = M + JJ, b + Jr
            log_det = linear.log_det(whole)
            expected = float(np.sum(((log - USUAL) / SPREAD) ** 2))
            return log_det + rr - linear.dot(part, linear.solve(whole, part)) + expected

        simplex = np.vstack([start, start + np.diag(np.where(start == 0.0, 0.001, 0.05 * start))])
        found = fitting.nelder_mead(criterion, simplex, near=0.03, like=0.03, most_calls=400)
        return np.asarray(np.clip(found, *LIMITS))
