"""The best sets, and which of their values are at a limit."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import PUBLISHED, SCEUA
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.posterior import limit_of
from pyrofit.results.searches import AllSearches


def at_bound(value: float, lower: float, upper: float) -> str:
    """Name the limit that a value is at, if any.

    >>> at_bound(0.989, 0.01, 0.99), at_bound(0.5, 0.01, 0.99)
    ('upper', '')
    """
    return limit_of((value - lower) / (upper - lower))


def best_sets(study: Study, searched: AllSearches) -> pd.DataFrame:
    """Return the set of the lowest cost of each cost function, whoever found it, SI units."""
    found = ends(study, searched)
    ours = found[found["found_by"] != PUBLISHED].reset_index(drop=True)
    lowest = ours.groupby("cost_function", sort=False)["cost"].idxmin()
    return ours.loc[lowest].reset_index(drop=True)


def ends(study: Study, searched: AllSearches) -> pd.DataFrame:
    """Return where every repetition and every start ended, and published sets, SI units.

    Columns: ``cost_function``, ``found_by``, ``number``, ``best`` (whether it has the lowest cost
    of those that an optimiser found for a cost function), ``cost``, and the parameters.
    """
    rows = []
    names = list(study.imp.estimate)
    every = searched.repetitions
    for cost in study.imp.costs:
        ours = every[every["cost_function"] == cost].to_dict("records")
        starts = {by.words: searched.starts[cost][key] for key, by in OPTIMISERS.items()}
        groups: dict[str, list[tuple[float, Mapping[Any, Any]]]] = {
            SCEUA: [(float(row["cost"]), row) for row in ours],
            **{by: [(s.cost, s.parameters) for s in e] for by, e in starts.items()},
        }
        if cost in (theirs := published_sets(study)):
            groups[PUBLISHED] = [(np.nan, theirs[cost])]
        for by, group in groups.items():
            best = min(range(len(group)), key=lambda i: group[i][0])
            for i, (value, values) in enumerate(group):
                about = {"cost_function": cost, "found_by": by, "number": i, "best": i == best}
                parameters = {name: float(values[name]) for name in names}
                rows.append({**about, "cost": value, **parameters})
    return pd.DataFrame(rows)


def published_sets(study: Study) -> dict[str, dict[str, float]]:
    """Return the published best set of every cost that has a complete one, SI units."""
    costs = study.published.costs if study.published else {}
    return {
        cost: {n: table[n][0] * study.parameters[n].factor for n in study.imp.estimate}
        for cost, table in costs.items()
        if set(study.imp.estimate) <= set(table)
    }
