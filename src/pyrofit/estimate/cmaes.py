"""CMA-ES (Hansen 2016, arXiv 1604.00772) as pycma implements it, from several random starts."""

from typing import Any

import numpy as np

from pyrofit.estimate.least_squares import Start, at_limits
from pyrofit.estimate.problem import Problem

SPREAD = 0.3
"""First standard deviation, as a fraction of the search range."""
NEAR = 1e-4
"""The search ends where its standard deviations are smaller, as fractions of the same."""
FLAT = 1e-6
"""It ends as well where the costs of the last generations differ by less than this share."""
LEAST = 1e-300
"""Least cost whose logarithm is taken."""


def minimise(problem: Problem, starts: int, seed: int, calls: int) -> list[Start]:
    """Minimise a cost by CMA-ES from random starts; best first.

    The search uses ranks alone, which the logarithm of the cost does not change; with it, a
    tolerance is a share of the cost. The parameters are scaled to [0, 1] by their limits.

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
    import cma  # a second, with Matplotlib, that the other steps do without

    options: dict[str, Any] = {
        "bounds": [0.0, 1.0],
        # The generator that is given, not NumPy's global one.
        "randn": lambda *shape: rng.standard_normal(shape),
        "seed": np.nan,
        "maxfevals": calls,
        "tolx": NEAR,
        "tolfun": FLAT,
        "verbose": -9,
    }
    span = problem.upper - problem.lower
    first = rng.uniform(0.05, 0.95, size=len(problem.names))
    strategy = cma.CMAEvolutionStrategy(first, SPREAD, options)
    best, found = np.inf, first
    done = 0
    while not strategy.stop():
        drawn = strategy.ask()
        scaled = np.clip(np.array(drawn), 0.0, 1.0)
        generation = problem.evaluate_all(problem.lower + scaled * span)
        costs = np.array([e.cost for e in generation])
        strategy.tell(drawn, np.log(np.maximum(costs, LEAST)))
        done += costs.size
        lowest = int(costs.argmin())
        if costs[lowest] < best:
            best, found = float(costs[lowest]), scaled[lowest]
    return Start(
        cost=best,
        values=problem.lower + found * span,
        calls=done,
        at_bound=at_limits(problem, found),
    )
