"""One simulation and the curves that are asked of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from pyrofit.model.experiment import Experiment
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves, Request


@dataclass(frozen=True)
class Run:
    """One simulation and the terms that look at it."""

    experiment: Experiment
    requests: dict[str, Request]


def is_alike(one: Run, other: Run) -> bool:
    """Tell whether two runs are repeats of one test that one simulation serves.

    Times may differ, as the simulation goes on to the last of them, see `asked_together`. Heated
    samples follow their own recorded temperatures: these must be the same.
    """
    repeats = one.experiment.repeat, other.experiment.repeat
    return (
        repeats[0] is not None
        and repeats[1] is not None
        and repeats[0].test == repeats[1].test
        and one.requests.keys() == other.requests.keys()
        and all(_is_same(one.requests[s], other.requests[s]) for s in one.requests)
        and one.experiment.as_simulated(one.requests) == other.experiment.as_simulated(one.requests)
    )


def alike(runs: Mapping[str, Run]) -> dict[str, str]:
    """Return of each run the first one that is simulated as it is."""
    found: dict[str, str] = {}
    for name, run in runs.items():
        same = (n for n in dict.fromkeys(found.values()) if is_alike(runs[n], run))
        found[name] = next(same, name)
    return found


def _is_same(one: Request, other: Request) -> bool:
    T, of_other = one.temperature_K, other.temperature_K
    if (one.average_s, one.output) != (other.average_s, other.output):
        return False
    if T is None or of_other is None:
        return T is of_other
    return np.array_equal(T, of_other) and np.array_equal(one.time_s, other.time_s)


def asked_together(runs: Sequence[Run]) -> dict[str, Request]:
    """Return the requests at all times that runs which are alike ask for."""
    first = runs[0].requests
    times = {s: [run.requests[s].time_s for run in runs] for s in first}
    return {
        s: request if _equal(times[s]) else request.at(reduce(np.union1d, times[s]))
        for s, request in first.items()
    }


def _equal(times: Sequence[FloatArray]) -> bool:
    return all(np.array_equal(times[0], other) for other in times[1:])


def own_curves(
    curves: Curves, asked: Mapping[str, Request], requests: Mapping[str, Request]
) -> Curves:
    """Return the curves at a run's own times out of those at all times."""
    if all(requests[s].time_s.size == asked[s].time_s.size for s in curves.signals):
        return curves
    signals = {
        s: curve[np.searchsorted(asked[s].time_s, requests[s].time_s)]
        for s, curve in curves.signals.items()
    }
    return curves._replace(signals=signals)
