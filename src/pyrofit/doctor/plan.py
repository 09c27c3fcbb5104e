"""Planned model calls and jobs of a study, and the size of its results.

Sizes are those of finished studies with 5 to 9 parameters (`twin`, `pmma`, `paper`).
"""

from collections.abc import Iterator
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.estimate.calls import optimiser_calls, sceua_calls
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.running.shares import jobs_of_repetitions

BYTES_PER_NUMBER = 11
"""Size of a number in a compressed history; 10.1 to 10.4 were measured."""
BYTES_BESIDE = 40_000_000
"""Tables, figures, predictions and the report of a study; 9 to 23 MB were measured."""


@dataclass(frozen=True)
class PartOfSearches:
    """The searches on one cost.

    Parameters
    ----------
    cost
        Name of the cost; "" is the kinetics stage.
    alone, together
        Model calls one by one, and in batches.
    jobs
        Number of jobs.
    exact
        Model calls in batches that are never coarser than the study asks for.
    """

    cost: str
    alone: float
    together: float
    jobs: int
    exact: float = 0.0

    @property
    def calls(self) -> float:
        """All model calls."""
        return self.alone + self.together + self.exact


def parts_of(study: Study, cores: int | None = None) -> Iterator[PartOfSearches]:
    """Yield the searches of a study, on the cores of this machine or, with None, on a cluster."""
    if study.kinetics is not None:
        stage = study.kinetics
        yield PartOfSearches(
            "", sceua_calls(stage), optimiser_calls(stage, "least_squares"), jobs=1
        )
    imp = study.imp
    jobs = jobs_of_repetitions(study, cores=cores)
    single = sum(len(share) for share in jobs if len(share) == 1)
    grouped = imp.repetitions - single
    sceua = sceua_calls(imp)
    beside = {name: optimiser_calls(imp, name) for name in OPTIMISERS}
    exact = sum(calls for name, calls in beside.items() if not OPTIMISERS[name].coarse)
    for cost in imp.costs:
        yield PartOfSearches(
            cost,
            alone=single * sceua,
            together=grouped * sceua + sum(beside.values()) - exact,
            jobs=len(jobs) + len(OPTIMISERS),
            exact=exact,
        )


def size_of_results(study: Study) -> float:
    """Return the approximate size of the results of a study [byte]."""
    stage = study.imp
    numbers = sum(len(stage.estimate) + len(terms) for terms in stage.costs.values())
    rows = stage.repetitions * sceua_calls(stage)
    # An archive and the report hold most files once more.
    return 2.0 * (BYTES_BESIDE + BYTES_PER_NUMBER * numbers * rows)
