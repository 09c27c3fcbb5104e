"""New tests that may be made on the same apparatus, derived from those that were calibrated."""

from collections.abc import Iterator

from pyrofit.estimate.problem import Problem
from pyrofit.experiments import KINDS
from pyrofit.experiments.base import Idea


def ideas(problem: Problem, measured: Problem) -> Iterator[Idea]:
    """Yield new tests like those of a problem, as each kind of experiment proposes them.

    Parameters
    ----------
    problem
        Problem of the calibrated signals.
    measured
        Problem of the calibrated and the held-out signals.
    """
    recorded = {
        name: {run.experiment.quantity(signal).name for signal in run.requests}
        for name, run in measured.runs.items()
    }
    for name, kind in KINDS.items():
        own, all_ = (
            {n: r.experiment for n, r in p.runs.items() if r.experiment.kind == name}
            for p in (problem, measured)
        )
        yield from kind.designs(own, all_, recorded)
