"""Results of `which_cost.py`, and means with their intervals."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from pyrofit.solver.arrays import FloatArray

CASE = ["kind", "name", "number"]
REFERENCE = "chi2"
"""The cost that others are compared with."""
WEAK = "k_r"
"""The parameter that the rate at 25 kW/m2 hardly depends on."""
DRAWS = 4000


def gathered(folder: Path, kind: str) -> pd.DataFrame:
    """Return all files of a kind as one table, with the group of each twin."""
    frames = [pd.read_csv(path) for path in sorted((folder / kind).glob("*.csv"))]
    found = pd.concat([frame for frame in frames if len(frame)], ignore_index=True)
    return found.assign(group=found["kind"].where(found["kind"] != "right", found["name"]))


def estimates(ends: pd.DataFrame) -> pd.DataFrame:
    """Return the best set of each cost and case, and the rms error of its parameters.

    ``error`` leaves out the parameter that is hardly seen, ``weak`` is that one's; fractions of the
    limits' distance.
    """
    best = ends[ends["optimiser"] == "best"].copy()
    columns = [c for c in best if c.startswith("x_") and c != f"x_{WEAK}"]
    twins = best["kind"] != "measured"
    squares = best.loc[twins, columns] ** 2
    best.loc[twins, "error"] = np.sqrt(squares.mean(axis=1))
    best["weak"] = best[f"x_{WEAK}"].abs()
    return best


def middle(values: FloatArray) -> float:
    """Return the geometric mean, which a few bad cases do not rule.

    >>> round(middle(np.array([1.0, 100.0])), 6)
    10.0
    """
    return float(np.exp(np.mean(np.log(values))))


def bootstrapped(values: FloatArray) -> tuple[float, float, float]:
    """Return the geometric mean over some cases, and its 95 % interval over resampled cases."""
    if not values.size:
        return (np.nan,) * 3
    rng = np.random.default_rng(1)
    drawn = values[rng.integers(0, values.size, (DRAWS, values.size))]
    low, high = np.quantile([middle(of) for of in drawn], (0.025, 0.975)).tolist()
    return middle(values), low, high


def ratios(best: pd.DataFrame, column: str, groups: Sequence[str], cost: str) -> FloatArray:
    """Return a column of a cost over the reference's, case by case."""
    of = best[best["group"].isin(groups)].set_index(CASE)
    mine, other = (of.loc[of["cost"] == name, column] for name in (cost, REFERENCE))
    return (mine / other).dropna().to_numpy(float)
