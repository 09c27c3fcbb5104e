"""How many model calls the searches of a study take, before they run."""

from collections.abc import Sequence

from pyrofit.config import Study
from pyrofit.config.stages import Imp, Kinetics

CALLS_PER_ROW = 1.63
"""Model calls of SCE-UA for each point of a generation after the first."""
STEPS = 20
"""Typical number of steps of least squares from one start."""


def search_calls(stage: Imp | Kinetics) -> tuple[float, int]:
    """Return the approximate number of model calls of a search of SCE-UA, and of least squares."""
    n = len(stage.estimate)
    points = (2 * n + 1) * (stage.sceua.complexes or n)
    sceua = points * (1.0 + CALLS_PER_ROW * (stage.sceua.generations - 1))
    return sceua, stage.least_squares.starts * STEPS * (2 * n + 1)


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
    sceua, squares = search_calls(stage)
    found = {
        f"imp_{cost}_{share[0]}": len(share) * sceua for cost in stage.costs for share in shares
    }
    # Of the two other optimisers the mean: the jobs of both have one rule.
    found["optimise"] = 0.5 * (squares + stage.cmaes.starts * stage.cmaes.calls)
    found["descent"] = squares / stage.least_squares.starts
    return found
