"""How many model calls the searches of a study take, before they run."""

from collections.abc import Sequence

from pyrofit.config import Study
from pyrofit.config.keys.stages import Imp, Kinetics
from pyrofit.estimate.optimisers import OPTIMISERS

CALLS_PER_ROW = 1.63
"""Model calls of SCE-UA for each point of a generation after the first."""


def sceua_calls(stage: Imp | Kinetics) -> float:
    """Return the approximate number of model calls of a search of SCE-UA."""
    n = len(stage.estimate)
    points = (2 * n + 1) * (stage.sceua.complexes or n)
    return points * (1.0 + CALLS_PER_ROW * (stage.sceua.generations - 1))


def optimiser_calls(stage: Imp | Kinetics, optimiser: str) -> int:
    """Return the approximate number of model calls of an optimiser, from all its starts."""
    return OPTIMISERS[optimiser].calls(getattr(stage, optimiser), len(stage.estimate))


def calls_of_jobs(study: Study, shares: Sequence[Sequence[str]]) -> dict[str, float]:
    """Return the approximate number of model calls of a job, by the name of its rule.

    Parameters
    ----------
    study
        The study.
    shares
        The repetitions of each job of a cost, as in the names of files.
    """
    stage = study.imp
    sceua = sceua_calls(stage)
    found = {
        f"imp_{cost}_{share[0]}": len(share) * sceua for cost in stage.costs for share in shares
    }
    # Of the optimisers beside SCE-UA the mean: their jobs have one rule.
    beside = [optimiser_calls(stage, optimiser) for optimiser in OPTIMISERS]
    found["optimise"] = sum(beside) / len(beside)
    found["descent"] = optimiser_calls(stage, "least_squares") / stage.least_squares.starts
    return found
