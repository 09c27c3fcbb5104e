"""CMA-ES (Hansen 2016, arXiv 1604.00772), from several random starts."""

import math
from collections import deque

import numpy as np

from pyrofit.estimate.least_squares import Start, at_limits
from pyrofit.estimate.problem import Problem
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

SPREAD = 0.3
"""First standard deviation, as a fraction of the search range."""
NEAR = 1e-4
"""The search ends where its standard deviations are smaller, as fractions of the same."""
FLAT = 1e-6
"""It ends as well where the costs of the last generations differ by less than this share."""


def minimise(problem: Problem, starts: int, seed: int, calls: int) -> list[Start]:
    """Minimise a cost by CMA-ES from random starts; best first.

    The parameters are scaled to [0, 1] by their limits. A set that is drawn beyond a limit is
    mirrored at it. The search uses ranks alone; of equal costs, that drawn first is the better one.

    Parameters
    ----------
    problem
        The cost to minimise.
    starts
        Number of starts, drawn uniformly within the limits.
    seed
        Seed of the draws; equal seeds give equal bits.
    calls
        Model calls after which a start begins no further generation.

    Returns
    -------
    list of Start
        Sorted by cost.
    """
    rng = np.random.default_rng(seed)
    ends = [_search(problem, rng, calls) for _ in range(starts)]
    return sorted(ends, key=lambda s: s.cost)


def _search(problem: Problem, rng: np.random.Generator, calls: int) -> Start:
    span = problem.upper - problem.lower
    strategy = Strategy(rng.uniform(0.05, 0.95, size=len(problem.names)), SPREAD)
    best, found = np.inf, strategy.mean
    lowest: deque[float] = deque(maxlen=strategy.memory)
    done = 0
    while done < calls and strategy.widest >= NEAR:
        drawn = strategy.ask(rng)
        scaled = mirrored(drawn)
        costs = np.array([e.cost for e in problem.evaluate_all(problem.lower + scaled * span)])
        strategy.tell(drawn, costs)
        done += costs.size
        first = int(costs.argmin())
        if costs[first] < best:
            best, found = float(costs[first]), scaled[first]
        lowest.append(float(costs[first]))
        flat = max(*lowest, costs.max()) <= (1.0 + FLAT) * min(lowest)
        if flat and len(lowest) == strategy.memory:
            break
    return Start(
        cost=best,
        values=problem.lower + found * span,
        calls=done,
        at_bound=at_limits(problem, found),
    )


def mirrored(x: FloatArray) -> FloatArray:
    """Return numbers mirrored at 0 and 1 until they are between.

    >>> mirrored(np.array([-0.25, 0.5, 1.25, 2.25])).tolist()
    [0.25, 0.5, 0.75, 0.25]
    """
    folded = np.mod(x, 2.0)
    return np.asarray(np.where(folded > 1.0, 2.0 - folded, folded))


class Strategy:
    """Mean, step and covariance of the distribution that a search draws from.

    Constants and formulas are those of appendix A of Hansen 2016, with negative weights of the
    worse half (Jastrebski and Arnold 2006).

    Parameters
    ----------
    mean
        Shape (n,).
    step
        Standard deviation of all numbers.
    """

    def __init__(self, mean: FloatArray, step: float) -> None:
        n = mean.size
        self.mean, self.step, self.generation = mean, step, 0
        self.count = 4 + int(3.0 * math.log(n))
        self.memory = 10 + math.ceil(30.0 * n / self.count)
        ranked = [math.log(0.5 * (self.count + 1)) - math.log(i + 1) for i in range(self.count)]
        better = np.array([w for w in ranked if w > 0.0])
        worse = np.array([w for w in ranked if w <= 0.0])
        mu = float(better.sum() ** 2 / np.sum(better**2))
        self.mu, self.better = mu, better / better.sum()
        self.c_path = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n)
        self.c_step = (mu + 2.0) / (n + mu + 5.0)
        self.damping = 1.0 + 2.0 * max(0.0, math.sqrt((mu - 1.0) / (n + 1.0)) - 1.0) + self.c_step
        self.c_one = 2.0 / ((n + 1.3) ** 2 + mu)
        self.c_mu = min(1.0 - self.c_one, 2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0) ** 2 + mu))
        mu_worse = float(worse.sum() ** 2 / np.sum(worse**2))
        size = min(
            1.0 + self.c_one / self.c_mu,
            1.0 + 2.0 * mu_worse / (mu + 2.0),
            (1.0 - self.c_one - self.c_mu) / (n * self.c_mu),
        )
        self.weights = np.concatenate([self.better, size * worse / -worse.sum()])
        self.usual = math.sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n))
        self.path_step, self.path = np.zeros(n), np.zeros(n)
        self._set(np.eye(n))

    def _set(self, covariance: FloatArray) -> None:
        values, self.axes = linear.eigen(0.5 * (covariance + covariance.T))
        self.sizes = np.sqrt(np.maximum(values, 1e-20 * float(values[-1])))
        self.covariance = covariance

    @property
    def widest(self) -> float:
        """Largest standard deviation of a number."""
        return self.step * math.sqrt(float(np.diag(self.covariance).max()))

    def ask(self, rng: np.random.Generator) -> FloatArray:
        """Draw a generation, shape (count, n)."""
        z = rng.standard_normal((self.count, self.mean.size))
        return self.mean + self.step * linear.product(z * self.sizes, self.axes.T)

    def tell(self, drawn: FloatArray, costs: FloatArray) -> None:
        """Learn from the costs of a generation."""
        n = self.mean.size
        y = (drawn[np.argsort(costs, kind="stable")] - self.mean) / self.step
        moved = linear.product(self.better, y[: self.better.size])
        self.mean = self.mean + self.step * moved
        self.generation += 1
        white = linear.product(self.axes, linear.product(self.axes.T, moved) / self.sizes)
        self.path_step = _onward(self.path_step, self.c_step, self.mu, white)
        length = linear.norm(self.path_step)
        begun = 1.0 - (1.0 - self.c_step) ** (2 * self.generation)
        short = length / math.sqrt(begun) < (1.4 + 2.0 / (n + 1.0)) * self.usual
        self.path = _onward(self.path, self.c_path, self.mu, moved if short else 0.0 * moved)
        lengths = np.sum((linear.product(y, self.axes) / self.sizes) ** 2, axis=1)
        weights = np.where(
            self.weights >= 0.0, self.weights, self.weights * n / np.maximum(lengths, 1e-300)
        )
        lost = 0.0 if short else self.c_one * self.c_path * (2.0 - self.c_path)
        kept = 1.0 + lost - self.c_one - self.c_mu * float(self.weights.sum())
        self._set(
            kept * self.covariance
            + self.c_one * np.outer(self.path, self.path)
            + self.c_mu * linear.product(y.T * weights, y)
        )
        rate = self.c_step / self.damping * (length / self.usual - 1.0)
        self.step *= math.exp(min(1.0, rate))


def _onward(path: FloatArray, rate: float, mu: float, moved: FloatArray) -> FloatArray:
    return np.asarray((1.0 - rate) * path + math.sqrt(rate * (2.0 - rate) * mu) * moved)
