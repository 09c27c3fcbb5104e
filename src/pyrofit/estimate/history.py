"""Results read from the histories of searches; needs no optimiser."""

from collections.abc import Callable

import pandas as pd

from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray

Progress = Callable[[int, int, float], None]
"""Told at the start of each generation: generation, calls so far, best cost so far."""


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
