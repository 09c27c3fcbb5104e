"""Table 4: best sets, means and standard deviations."""

from typing import Any

import pandas as pd

from pyrofit.analysis.best_sets import at_bound
from pyrofit.analysis.estimates import estimated
from pyrofit.analysis.optimisers import lowest_of
from pyrofit.config import Study
from pyrofit.results import searches
from pyrofit.results.files import Results
from pyrofit.show.names import flag
from pyrofit.show.table import Table

WIDE_SPREAD = 0.20
"""A sigma above this fraction of the limits' distance says that the data do not determine it."""


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
    known = {e.name: e for e in estimated(study, results) if e.stage == "imp"}
    rows = []
    for cost in study.imp.costs:
        group = summary[summary["cost_function"] == cost]
        best = lowest_of(group)
        rows.append(_row(study, cost, "fit", group["cost"], float(best["cost"])))
        for name in study.imp.estimate:
            factor = study.parameters[name].factor
            row = _row(study, cost, name, group[name] / factor, float(best[name]) / factor)
            row["flags"] = "; ".join(filter(None, [row["flags"], flag(known[name])]))
            rows.append(row)
    frame = pd.DataFrame(rows)
    absent = [] if study.published else [f"published_{what}" for what in ("best", "mean", "sigma")]
    return frame.drop(columns=absent)


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


TABLE = Table(
    place=20,
    applies=lambda study: True,
    make=table4,
    title="Best set, mean and standard deviation over the repetitions",
    paper="Table 4",
    note="sigma is the standard deviation over the n repetitions with n − 1 as divisor: the "
    "scatter of the optimiser, not the uncertainty of the parameter. "
    "'At bound': the best value lies within 0.5 % of the limits' distance from a limit. "
    "'Spread > 20 % of limits': sigma exceeds this share of it, the optimiser finds no one "
    "value. 'By the data': from the 95 % interval, see 'What the data determine'.",
    headings={
        "published_best": "published best",
        "published_mean": "published mean",
        "published_sigma": "published sigma",
        "lower_limit": "lower limit",
        "upper_limit": "upper limit",
    },
    group_by="cost_function",
)
