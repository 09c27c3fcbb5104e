"""Table 4 and the comparison of the optimisers."""

from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.files import Results
from pyrofit.stages import outcomes
from pyrofit.tables.determined import estimates, flag

AT_BOUND = 0.005
"""A best value this close to a limit, as a fraction of the limits' distance, is at the bound."""
WIDE_SPREAD = 0.20
"""A sigma above this fraction of the limits' distance says that the data do not determine it."""
LOWER = 0.01
"""Relative difference of two costs from which one optimiser is said to be ahead."""

LOCAL_OPTIMUM = "SCE-UA stopped at a local optimum"
NOT_A_MINIMUM = "SCE-UA had not converged: least squares goes on from its best set"
AGREE = "both agree within 1 %"
LEAST_SQUARES_BEHIND = "SCE-UA found a lower cost than least squares"


def table4(study: Study, results: Results) -> pd.DataFrame:
    """Table 4: best set, mean and sigma over the repetitions, beside published ones.

    sigma = sqrt(sum (x - mean)^2 / (n - 1)) over n repetitions; the paper does not say which of
    n and n - 1 divides.

    Returns
    -------
    pandas.DataFrame
        One row per cost function and quantity ('fit' and each parameter, in its own unit).
    """
    summary = outcomes.summary(study, results)
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
    lower, upper = (parameter.lower, parameter.upper) if parameter else (None, None)
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
    found = []
    if best - lower <= AT_BOUND * span:
        found.append("at bound (lower)")
    if upper - best <= AT_BOUND * span:
        found.append("at bound (upper)")
    if sigma > WIDE_SPREAD * span:
        found.append("spread > 20 % of limits")
    return "; ".join(found)


def costs(study: Study, results: Results) -> pd.DataFrame:
    """Compare SCE-UA with multistart least squares on the same costs.

    Returns
    -------
    pandas.DataFrame
        One row per cost function; model calls are those of all repetitions and of all starts.
    """
    summary = outcomes.summary(study, results)
    return pd.DataFrame(
        [
            _comparison(
                cost,
                summary[summary["cost_function"] == cost],
                outcomes.starts(study, results, cost),
                outcomes.end_of_descent(results, cost),
            )
            for cost in study.imp.costs
        ]
    )


def _comparison(
    cost: str, group: pd.DataFrame, starts: list[dict[str, Any]], descent: dict[str, Any]
) -> dict[str, Any]:
    best = _lowest(group)
    squares = min(starts, key=lambda start: float(start["cost"]))
    theirs, ours = float(squares["cost"]), float(best["cost"])
    near = sum(float(start["cost"]) <= (1.0 + LOWER) * theirs for start in starts)
    return {
        "cost_function": cost,
        "repetitions": len(group),
        "sceua_best": ours,
        "sceua_best_solver_error": 4.0 / 3.0 * abs(float(best["cost_refined"]) - ours),
        "sceua_mean": float(group["cost"].mean()),
        "sceua_calls": int(group["calls"].sum()),
        "sceua_failed_calls": int(group["failed_calls"].sum()),
        "least_squares_from_sceua": float(descent["cost"]),
        "starts": len(starts),
        "starts_at_best": near,
        "least_squares_best": theirs,
        "least_squares_calls": sum(int(start["calls"]) for start in starts),
        "least_squares_at_bound": ", ".join(squares["at_bound"]),
        "ratio": theirs / ours if ours > 0.0 else None,
        "remark": remark(ours, theirs, float(descent["cost"])),
    }


def remark(sceua: float, least_squares: float, descent: float) -> str:
    """Say which optimiser is ahead; ``descent`` is the cost least squares reaches from SCE-UA."""
    if least_squares < (1.0 - LOWER) * sceua:
        return LOCAL_OPTIMUM if descent >= (1.0 - LOWER) * sceua else NOT_A_MINIMUM
    return LEAST_SQUARES_BEHIND if sceua < (1.0 - LOWER) * least_squares else AGREE
