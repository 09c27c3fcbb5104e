"""Seeds of searches, and what is read from their histories; needs no optimiser."""

import hashlib
from collections.abc import Callable

import pandas as pd

from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray

Progress = Callable[[int, int, float], None]
"""Told at the start of each generation: generation, calls so far, best cost so far."""


def seed_for(study_seed: int, *identity: object) -> int:
    """Return the seed of one search, a function of the study's seed and its identity alone.

    >>> seed_for(1, "RMSE", 3) == seed_for(1, "RMSE", 3) != seed_for(1, "RMSE", 4)
    True
    """
    text = "/".join(str(part) for part in (study_seed, *identity))
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], "little") % 2**30


def best_of(history: pd.DataFrame, problem: Problem) -> tuple[float, FloatArray]:
    """Return the lowest cost of a history and its parameter set (the first where they tie)."""
    row = history.iloc[int(history["cost"].to_numpy().argmin())]
    return float(row["cost"]), row[list(problem.names)].to_numpy(float)


def convergence(history: pd.DataFrame) -> pd.DataFrame:
    """Return the running minimum of the cost at the end of each generation.

    Columns: ``generation``, ``calls`` (model calls so far), ``best_cost``.
    """
    ends = history.groupby("generation")["call"].max()
    running = history["cost"].cummin().to_numpy()
    return pd.DataFrame(
        {
            "generation": ends.index.to_numpy(),
            "calls": ends.to_numpy(),
            "best_cost": running[ends.to_numpy() - 1],
        }
    )
