"""The best set of each cost function, beside the intervals of the answer."""

from typing import Any

import pandas as pd

from pyrofit.analysis.best_sets import at_bound, best_sets
from pyrofit.analysis.estimates import Estimated, estimates_of
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import identification, searches
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table


def best_sets_table(study: Study, results: Results) -> pd.DataFrame:
    """List the set of the lowest cost that any optimiser found, a column for each cost function.

    Returns
    -------
    pandas.DataFrame
        One row per parameter of the inverse modelling, in its own unit. ``outside`` names the cost
        functions whose value lies outside the interval, ``at_limit`` those that ended at a limit.
    """
    known = [
        e for e in estimates_of(study, identification.read(study, results)) if e.stage == "imp"
    ]
    best = best_sets(study, searches.read(study, results, OPTIMISERS)).to_dict("records")
    return pd.DataFrame([_row(study, e, best) for e in known])


def _row(study: Study, e: Estimated, best: list[dict[Any, Any]]) -> Row:
    factor = study.parameters[e.name].factor
    lower, upper = (limit * factor for limit in study.search_limits(e.name))
    row: Row = {"parameter": e.name, "unit": e.unit, "low": e.low, "high": e.high}
    outside, at_limit = [], []
    for one in best:
        cost, value = str(one["cost_function"]), float(one[e.name])
        row[f"{cost} ({one['found_by']})"] = value / factor
        outside += [] if e.low <= value / factor <= e.high else [cost]
        at_limit += [cost] if at_bound(value, lower, upper) else []
    # None where there is nothing: a column without any is not shown.
    return {**row, "outside": ", ".join(outside) or None, "at_limit": ", ".join(at_limit) or None}


TABLE = Table(
    place=5,
    make=best_sets_table,
    title="The best set of each cost function, and the intervals of the answer",
    note="Best sets: lowest cost of all optimisers that used this cost. Outside: cost functions "
    "whose value lies outside the 95 % interval of the estimate. Use the values of a set together.",
    headings={"low": "95 % low", "high": "95 % high", "at_limit": "at a limit"},
)
