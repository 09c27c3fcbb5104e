"""Coarser runs for searches, as far as nobody can see the difference in the data.

A search compares costs. The error of a coarser run does no harm while it is small beside the noise
of the measured signal. If a set fits badly, its misfit takes the place of the noise.
"""

from dataclasses import replace

import numpy as np

from pyrofit.cost.distances import root_mean_square
from pyrofit.estimate.problem import Outcome, Problem
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.arrays import FloatArray

OF_NOISE = 0.05
"""Largest error of a coarser run, as a share of the noise of a signal: in chi-square less than one
for up to 400 points."""
OF_MISFIT = 0.02
"""The same as a share of the misfit of a set: the largest relative change of its cost."""
DRAWN = 15
"""Sets within the limits whose runs are compared, beside that of the middles."""


def for_search(problem: Problem) -> Problem:
    """Return the problem with coarser runs, or itself where their error is too large.

    Compared are the sets of the middles of the limits and of some draws, see `are_close`.
    """
    if not any(isinstance(run.experiment, SlabExperiment) for run in problem.runs.values()):
        return problem
    coarse = replace(problem, accuracy=problem.accuracy.coarsened())
    rng = np.random.default_rng(DRAWN)
    drawn = rng.uniform(size=(DRAWN, len(problem.names)))
    u = np.vstack([np.full(len(problem.names), 0.5), drawn])
    return coarse if all(are_close(coarse, problem, problem.lower + u * problem.span)) else problem


def are_close(coarse: Problem, problem: Problem, sets: FloatArray) -> list[bool]:
    """Tell of each set whether its coarser run is as good as that of a problem.

    They are if both finish or fail, and if for each term of the cost

        rms(y_coarse - y) <= max(OF_NOISE noise, OF_MISFIT rms(y - target)),

    with the noise of `point_noise` and y the curve at the target's times.

    Parameters
    ----------
    coarse, problem
        The same problem with coarser and with its own runs.
    sets
        Sets in SI units, shape (sets, parameters).
    """
    targets = [term.target.value for _, term in problem.cost.terms]
    noise = [point_noise(target) for target in targets]

    def close(pair: tuple[Outcome, Outcome]) -> bool:
        (status, rough), (own, fine) = pair
        if not (status.finished and own.finished):
            return status.finished == own.finished
        return all(
            root_mean_square(a - b) <= max(OF_NOISE * sd, OF_MISFIT * root_mean_square(b - target))
            for a, b, target, sd in zip(rough, fine, targets, noise, strict=True)
        )

    pairs = zip(coarse.simulate_all(sets), problem.simulate_all(sets), strict=True)
    return [close(pair) for pair in pairs]


def point_noise(values: FloatArray) -> float:
    """Return the standard deviation of the noise of single points, from second differences.

    The variance of y_(i-1) - 2 y_i + y_(i+1) is six times that of white noise; the curve itself
    adds little. The median is used, so that a jump does not count. Zero for fewer than 3 points.

    >>> point_noise(np.arange(10.0) ** 2 / 2.0)  # a parabola of second difference 1
    0.605...
    """
    bends = np.abs(np.diff(values, 2))
    return float(np.median(bends)) / (0.6744897501960817 * 6.0**0.5) if bends.size else 0.0
