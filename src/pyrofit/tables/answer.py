"""The answer: one estimate of each parameter, and the best set of each cost function beside it."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.stages.compare import ends
from pyrofit.tables.describe import PUBLISHED
from pyrofit.tables.determined import WORDS, determined, flag
from pyrofit.tables.imp import at_bound


def answer(study: Study, results: Results) -> pd.DataFrame:
    """List estimate, 95 % interval, best sets and what speaks against a value, by parameter.

    Returns
    -------
    pandas.DataFrame
        One row per parameter, in its own unit. A column for each cost function holds the set of
        the lowest cost that any optimiser found, and names the optimiser.
    """
    known = determined(study, results)
    kept = ["fit", "parameter", "unit", "estimate", "low", "high", "truth"]
    frame = known[[column for column in kept if column in known]].copy()
    best = best_sets(study, results)
    flags = [[flag(verdict)] for verdict in known["verdict"]]
    for row in best.to_dict("records"):
        frame[column_of(row)] = [
            float(row[name]) / study.parameters[name].factor if fit == WORDS["imp"] else None
            for fit, name in zip(frame["fit"], frame["parameter"], strict=True)
        ]
    for said, fit, name in zip(flags, frame["fit"], frame["parameter"], strict=True):
        if fit == WORDS["imp"]:
            said.append(_at_limit(study, name, best))
    # None where there is nothing: a column without any is not shown.
    frame["flags"] = ["; ".join(filter(None, said)) or None for said in flags]
    return frame


def column_of(row: Mapping[Any, Any]) -> str:
    """Return the heading of a best set."""
    return f"{row['cost_function']} ({row['found_by']})"


def best_sets(study: Study, results: Results) -> pd.DataFrame:
    """Return the set of the lowest cost of each cost function, whoever found it, SI units."""
    found = ends(study, results)
    ours = found[found["found_by"] != PUBLISHED].reset_index(drop=True)
    lowest = ours.groupby("cost_function", sort=False)["cost"].idxmin()
    return ours.loc[lowest].reset_index(drop=True)


def _at_limit(study: Study, name: str, best: pd.DataFrame) -> str:
    """Name the cost functions whose best set has a parameter at a limit."""
    factor = study.parameters[name].factor
    lower, upper = (limit * factor for limit in study.search_limits(name))
    names = [
        str(row["cost_function"])
        for row in best.to_dict("records")
        if at_bound(float(row[name]), lower, upper)
    ]
    return f"at a limit: {', '.join(names)}" if names else ""
