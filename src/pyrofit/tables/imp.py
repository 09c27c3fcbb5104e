"""Table 4 and the comparison of the optimisers."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import searches
from pyrofit.results.files import Results
from pyrofit.tables.describe import CMAES, LEAST_SQUARES
from pyrofit.tables.determined import estimates, flag

AT_BOUND = 0.005
"""A best value this close to a limit, as a fraction of the limits' distance, is at the bound."""
WIDE_SPREAD = 0.20
"""A sigma above this fraction of the limits' distance says that the data do not determine it."""
LOWER = 0.01
"""Relative difference of two costs from which one optimiser is said to be ahead."""

WORDS = {"least_squares": LEAST_SQUARES, "cmaes": CMAES}
"""Optimisers in words, by the beginning of their columns."""

LOCAL_OPTIMUM = "SCE-UA stopped at a local optimum"
NOT_A_MINIMUM = "SCE-UA had not converged: least squares goes on from its best set"
AGREE = "all agree within 1 %"
SCEUA_AHEAD = "SCE-UA found a lower cost than the others"


def table4(study: Study, results: Results) -> pd.DataFrame:
    """Table 4: best set, mean and sigma over the repetitions, beside published ones.

    sigma = sqrt(sum (x - mean)^2 / (n - 1)) over n repetitions; the paper does not say which of
    n and n - 1 divides.

    Returns
    -------
    pandas.DataFrame
        One row per cost function and quantity ('fit' and each parameter, in its own unit).
    """
    summary = searches.summary(study, results)
    verdicts = estimates(study, results)["verdict"]
    rows = []
    for cost in study.imp.costs:
        group = summary[summary["cost_function"] == cost]
        best = _lowest(group)
        rows.append(_row(study, cost, "fit", group["cost"], float(best["cost"])))
        for name in study.imp.estimate:
            factor = study.parameters[name].factor
            row = _row(study, cost, name, group[name] / factor, float(best[name]) / factor)
            row["flags"] = "; ".join(filter(None, [row["flags"], flag(verdicts[name])]))
            rows.append(row)
    frame = pd.DataFrame(rows)
    absent = [] if study.published else [f"published_{what}" for what in ("best", "mean", "sigma")]
    return frame.drop(columns=absent)


def _lowest(group: pd.DataFrame) -> pd.Series:
    return group.iloc[int(group["cost"].argmin())]


def _row(study: Study, cost: str, name: str, values: pd.Series, best: float) -> dict[str, Any]:
    parameter = study.parameters[name] if name != "fit" else None
    published = {} if study.published is None else study.published.costs.get(cost, {})
    theirs = published.get(name, (None, None, None))
    sigma = float(values.std(ddof=1))
    lower, upper = study.search_limits(name) if parameter else (None, None)
    return {
        "cost_function": cost,
        "quantity": name,
        "unit": parameter.unit if parameter else "-",
        "best": best,
        "mean": float(values.mean()),
        "sigma": sigma,
        "published_best": theirs[0],
        "published_mean": theirs[1],
        "published_sigma": theirs[2],
        "lower_limit": lower,
        "upper_limit": upper,
        "flags": flags(best, sigma, lower, upper),
    }


def flags(best: float, sigma: float, lower: float | None, upper: float | None) -> str:
    """Say in words what is wrong with an estimate.

    >>> flags(0.989, 0.25, 0.01, 0.99)
    'at bound (upper); spread > 20 % of limits'
    """
    if lower is None or upper is None:
        return ""
    span = upper - lower
    found = [f"at bound ({end})"] if (end := at_bound(best, lower, upper)) else []
    if sigma > WIDE_SPREAD * span:
        found.append("spread > 20 % of limits")
    return "; ".join(found)


def at_bound(value: float, lower: float, upper: float) -> str:
    """Name the limit that a value is at, if any.

    >>> at_bound(0.989, 0.01, 0.99), at_bound(0.5, 0.01, 0.99)
    ('upper', '')
    """
    near = AT_BOUND * (upper - lower)
    return "lower" if value - lower <= near else "upper" if upper - value <= near else ""


def costs(study: Study, results: Results) -> pd.DataFrame:
    """Compare SCE-UA with multistart least squares and CMA-ES on the same costs.

    Returns
    -------
    pandas.DataFrame
        One row per cost function; model calls are those of all repetitions and of all starts.
    """
    summary = searches.summary(study, results)
    rows = []
    for cost in study.imp.costs:
        others = {
            "least_squares": searches.starts(study, results, cost),
            "cmaes": searches.cmaes(study, results, cost),
        }
        descent = float(searches.end_of_descent(results, cost)["cost"])
        group = summary[summary["cost_function"] == cost]
        rows.append({"cost_function": cost, **_comparison(group, others, descent)})
    return pd.DataFrame(rows)


def _comparison(
    group: pd.DataFrame, others: Mapping[str, list[dict[str, Any]]], descent: float
) -> dict[str, Any]:
    best = _lowest(group)
    ours = float(best["cost"])
    lowest = {name: min(float(s["cost"]) for s in starts) for name, starts in others.items()}
    theirs = min(lowest.values())
    row = {
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
        "lowest_by": WORDS[min(lowest, key=lambda name: lowest[name])],
        "ratio": theirs / ours if ours > 0.0 else None,
        "remark": remark(ours, theirs, descent),
    }


def _starts(name: str, starts: list[dict[str, Any]]) -> dict[str, Any]:
    """Return how the starts of an optimiser ended, under names that begin with its own."""
    best = min(starts, key=lambda start: float(start["cost"]))
    lowest = float(best["cost"])
    near = sum(float(start["cost"]) <= (1.0 + LOWER) * lowest for start in starts)
    return {
        f"{name}_starts": len(starts),
        f"{name}_starts_at_best": near,
        f"{name}_best": lowest,
        f"{name}_calls": sum(int(start["calls"]) for start in starts),
        f"{name}_at_bound": ", ".join(best["at_bound"]),
    }


def remark(sceua: float, others: float, descent: float) -> str:
    """Say who is ahead; ``descent`` is the cost that least squares reaches from SCE-UA's best."""
    if others < (1.0 - LOWER) * sceua:
        return LOCAL_OPTIMUM if descent >= (1.0 - LOWER) * sceua else NOT_A_MINIMUM
    return SCEUA_AHEAD if sceua < (1.0 - LOWER) * others else AGREE
