"""One simulation and the curves that are asked of it."""

from dataclasses import dataclass

import numpy as np

from pyrofit.model.experiment import Experiment
from pyrofit.solver.curves import Request


@dataclass(frozen=True)
class Run:
    """One simulation and the terms that look at it."""

    experiment: Experiment
    requests: dict[str, Request]


def is_alike(one: Run, other: Run) -> bool:
    """Tell whether two runs are repeats of one test with the same curves at the same times."""
    repeats = one.experiment.repeat, other.experiment.repeat
    return (
        repeats[0] is not None
        and repeats[1] is not None
        and repeats[0].test == repeats[1].test
        and one.requests.keys() == other.requests.keys()
        and all(_is_same(one.requests[s], other.requests[s]) for s in one.requests)
        and one.experiment.as_simulated(one.requests) == other.experiment.as_simulated(one.requests)
    )


def _is_same(one: Request, other: Request) -> bool:
    pairs = ((one.time_s, other.time_s), (one.temperature_K, other.temperature_K))
    return (one.average_s, one.output) == (other.average_s, other.output) and all(
        a is b or (a is not None and b is not None and np.array_equal(a, b)) for a, b in pairs
    )
