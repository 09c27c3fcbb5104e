"""The family of good sets: those whose cost is near the lowest known one, few that lie far apart.

Data that leave a parameter undetermined leave many sets of nearly the same cost. One best set hides
that; the predictions of all good sets show it (Beven and Binley 1992, doi 10.1002/hyp.3360060305).
The ends of optimisers are no such family: they crowd at a few places, or stop before the sets are
good.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray

GOOD = 1.05
"""A set is good up to this multiple of the lowest cost. With n independent points and p parameters
the joint 95 % region of least squares (Beale 1960, doi 10.1111/j.2517-6161.1960.tb00353.x) reaches
to sqrt(1 + p F/(n - p)) of the lowest: 1.094 for p = 9 and n = 100, 1.044 for n = 200."""
MOST = 60
"""Most sets of a family: enough to reach all ends of the region of good sets."""
WALKERS = 24
SWEEPS = 80


def walk_about(
    problem: Problem, best: FloatArray, top: float, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Walk about the region where the cost is at most ``top``, from a set in it.

    Hit and run (Smith 1984, doi 10.1287/opre.32.6.1296) by several walkers at once: each takes a
    direction and a place on its line within the limits. Where the cost is too high, the line is cut
    off there and tried again (Neal 2003, doi 10.1214/aos/1056562461). Directions are those of a
    parameter, of a random vector, or between two good sets, along which the region is long.

    Parameters
    ----------
    problem, rng
        The problem, and the generator of all that is random.
    best
        The set to start from, SI units, shape (parameters,).
    top
        Highest cost of a good set.

    Returns
    -------
    tuple of ndarray
        Costs, shape (n,), and sets in SI units, shape (n, parameters), of all good sets met, that
        which was given among them.
    """
    span = problem.upper - problem.lower
    start = np.clip((best - problem.lower) / span, 0.0, 1.0)
    pool, costs = [start], [problem.evaluate(best).cost]
    walkers = [_Walker.at(start, pool, rng) for _ in range(WALKERS)]
    for _ in range(SWEEPS):
        tried = [walker.propose(rng) for walker in walkers]
        found = problem.evaluate_all(problem.lower + np.array(tried) * span)
        for i, (x, result) in enumerate(zip(tried, found, strict=True)):
            if result.cost <= top:
                pool.append(x)
                costs.append(result.cost)
                walkers[i] = _Walker.at(x, pool, rng)
            else:
                walkers[i].cut_off()
    return np.array(costs), problem.lower + np.array(pool) * span


@dataclass
class _Walker:
    """A good set, and a line through it: x = place + step direction, low <= step <= high."""

    place: FloatArray
    direction: FloatArray
    low: float
    high: float
    step: float = 0.0

    @classmethod
    def at(cls, place: FloatArray, pool: list[FloatArray], rng: np.random.Generator) -> "_Walker":
        """Return a walker with a new line, which ends at the limits."""
        direction = _direction(place.size, pool, rng)
        ends = (np.array([[0.0], [1.0]]) - place)[:, direction != 0.0] / direction[direction != 0.0]
        return cls(place, direction, float(ends.min(axis=0).max()), float(ends.max(axis=0).min()))

    def propose(self, rng: np.random.Generator) -> FloatArray:
        """Return a place on the line."""
        # `uniform` refuses a line of length -0.0, as in a corner of the limits.
        self.step = self.low + (self.high - self.low) * float(rng.random())
        return np.clip(self.place + self.step * self.direction, 0.0, 1.0)

    def cut_off(self) -> None:
        """Cut the line off where the last place was no good one."""
        self.low, self.high = (self.step, self.high) if self.step < 0.0 else (self.low, self.step)


def _direction(size: int, pool: list[FloatArray], rng: np.random.Generator) -> FloatArray:
    """Return a parameter's direction, a random one, or that between two good sets."""
    kind = int(rng.integers(4))
    if kind == 0:
        return np.asarray(np.eye(size)[int(rng.integers(size))])
    if kind > 1 and len(pool) > size:
        first, second = rng.choice(len(pool), 2, replace=False)
        if np.any(pool[first] != pool[second]):
            return np.asarray(pool[first] - pool[second])
    return rng.standard_normal(size)


def farthest_apart(scaled: FloatArray) -> NDArray[np.int64]:
    """Return which sets lie farthest apart, beginning with the first.

    Each is the one that is farthest from all before it (Gonzalez 1985,
    doi 10.1016/0304-3975(85)90224-5).

    Parameters
    ----------
    scaled
        The sets in [0, 1] of the search range, shape (n, parameters).

    Returns
    -------
    ndarray
        Indices, at most `MOST`, without sets that are equal.

    Examples
    --------
    >>> farthest_apart(np.array([[0.5], [0.6], [0.9], [0.5]])).tolist()
    [0, 2, 1]
    """
    chosen = [0]
    away = _distances(scaled, scaled[0])
    while len(chosen) < MOST and away.max() > 0.0:
        chosen.append(int(away.argmax()))
        away = np.minimum(away, _distances(scaled, scaled[chosen[-1]]))
    return np.array(chosen, dtype=np.int64)


def _distances(scaled: FloatArray, one: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(np.sum((scaled - one) ** 2, axis=1)))
