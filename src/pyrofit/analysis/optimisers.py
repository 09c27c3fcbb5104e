"""Optimisers compared on the same costs."""

from collections.abc import Mapping

import pandas as pd

from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results.searches import End

LOWER = 0.01
"""Relative difference of two costs from which one optimiser is said to be ahead."""


LOCAL_OPTIMUM = "SCE-UA stopped at a local optimum"


NOT_A_MINIMUM = "SCE-UA had not converged: least squares from its best set finds a lower cost"


AGREE = "all agree within 1 %"


SCEUA_AHEAD = "SCE-UA found a lower cost than the others"


def comparison(
    group: pd.DataFrame, others: Mapping[str, list[End]], descent: float
) -> dict[str, object]:
    """Return SCE-UA's repetitions beside the starts of the other optimisers, on one cost."""
    best = lowest_of(group)
    ours = float(best["cost"])
    lowest = {name: min(s.cost for s in starts) for name, starts in others.items()}
    theirs = min(lowest.values())
    row: dict[str, object] = {
        "repetitions": len(group),
        "sceua_best": ours,
        "sceua_best_solver_error": 4.0 / 3.0 * abs(float(best["cost_refined"]) - ours),
        "sceua_mean": float(group["cost"].mean()),
        "sceua_at_lowest": int((group["cost"] <= (1.0 + LOWER) * min(ours, theirs)).sum()),
        "sceua_calls": int(group["calls"].sum()),
        "sceua_failed_calls": int(group["failed_calls"].sum()),
        "least_squares_from_sceua": descent,
    }
    for name, starts in others.items():
        row |= _starts(name, starts)
    return {
        **row,
        "lowest_by": OPTIMISERS[min(lowest, key=lambda name: lowest[name])].words,
        "ratio": theirs / ours if ours > 0.0 else None,
        "remark": who_is_ahead(ours, theirs, descent),
    }


def _starts(name: str, starts: list[End]) -> dict[str, object]:
    """Return how the starts of an optimiser ended, under names that begin with its own."""
    best = min(starts, key=lambda start: start.cost)
    lowest = best.cost
    near = sum(start.cost <= (1.0 + LOWER) * lowest for start in starts)
    return {
        f"{name}_starts": len(starts),
        f"{name}_starts_at_best": near,
        f"{name}_best": lowest,
        f"{name}_calls": sum(start.calls for start in starts),
        f"{name}_at_bound": ", ".join(best.at_bound),
    }


def who_is_ahead(sceua: float, others: float, descent: float) -> str:
    """Say who is ahead; ``descent`` is the cost that least squares reaches from SCE-UA's best."""
    if others < (1.0 - LOWER) * sceua:
        return LOCAL_OPTIMUM if descent >= (1.0 - LOWER) * sceua else NOT_A_MINIMUM
    return SCEUA_AHEAD if sceua < (1.0 - LOWER) * others else AGREE


def lowest_of(group: pd.DataFrame) -> pd.Series:
    """Return the row of the lowest cost."""
    return group.iloc[int(group["cost"].argmin())]
