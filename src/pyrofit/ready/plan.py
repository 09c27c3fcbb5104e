"""Planned model calls and jobs of a study, and the size of its results.

Sizes are those of finished studies with 5 to 9 parameters (`twin`, `pmma`, `paper`).
"""

from collections.abc import Iterator
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.running.calls import search_calls
from pyrofit.running.shares import shares

BYTES_PER_NUMBER = 11
"""Size of a number in a compressed history; 10.1 to 10.4 were measured."""
BYTES_BESIDE = 40_000_000
"""Tables, figures, predictions and the report of a study; 9 to 23 MB were measured."""


@dataclass(frozen=True)
class Part:
    """The searches on one cost.

    Parameters
    ----------
    cost
        Name of the cost; "" is the kinetics stage.
    alone, together
        Model calls one by one, and in batches.
    jobs
        Number of jobs.
    """

    cost: str
    alone: float
    together: float
    jobs: int


def parts_of(study: Study, cores: int | None = None) -> Iterator[Part]:
    """Yield the searches of a study, on the cores of this machine or, with None, on a cluster."""
    if study.kinetics is not None:
        calls = search_calls(study.kinetics)
        yield Part("", calls[0], calls[1], jobs=1)
    stage = study.imp
    jobs = shares(study, cores=cores)
    single = sum(len(share) for share in jobs if len(share) == 1)
    grouped = stage.repetitions - single
    sceua, squares = search_calls(stage)
    beside = squares + stage.cmaes.starts * stage.cmaes.calls
    for cost in stage.costs:
        yield Part(
            cost,
            alone=single * sceua,
            together=grouped * sceua + beside,
            jobs=len(jobs) + 2,
        )


def bytes_of(study: Study) -> float:
    """Return the approximate size of the results of a study [byte]."""
    stage = study.imp
    numbers = sum(len(stage.estimate) + len(terms) for terms in stage.costs.values())
    rows = stage.repetitions * search_calls(stage)[0]
    # An archive and the report hold most files once more.
    return 2.0 * (BYTES_BESIDE + BYTES_PER_NUMBER * numbers * rows)
