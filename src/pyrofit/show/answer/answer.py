"""The answer: one estimate of each parameter, and the best set of each cost function."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.analysis.best_sets import at_bound, best_sets, ends
from pyrofit.analysis.estimates import Estimated, estimated
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import identification, searches
from pyrofit.results.files import Results
from pyrofit.show.answer.chosen import chosen_set
from pyrofit.show.names import STAGES, flag
from pyrofit.show.table import Table


def answer(study: Study, results: Results) -> pd.DataFrame:
    """List estimate, 95 % interval, best sets and objections to a value, by parameter.

    Returns
    -------
    pandas.DataFrame
        One row per parameter, in its own unit. A column for each cost function holds the set of
        the lowest cost that any optimiser found, and names the optimiser. The recommended set has a
        column, too.
    """
    known = estimated(study, identification.read(study, results))
    best = _sets(study, results)
    frame = pd.DataFrame([_row(study, estimate) for estimate in known])
    for row in best.to_dict("records"):
        frame[column_of(row)] = [
            float(row[e.name]) / study.parameters[e.name].factor if e.stage == "imp" else None
            for e in known
        ]
    flags = [(flag(e), _at_limit(study, e.name, best) if e.stage == "imp" else "") for e in known]
    # None where there is nothing: a column without any is not shown.
    frame["flags"] = ["; ".join(filter(None, said)) or None for said in flags]
    return frame


def _sets(study: Study, results: Results) -> pd.DataFrame:
    """Return the best set of each cost function, and the recommended one if it is another."""
    searched = searches.read(study, results, OPTIMISERS)
    best, chosen = best_sets(study, searched), chosen_set(study, results)
    every = ends(study, searched)
    mine = every[every["best"] & (every["cost_function"] == chosen.cost_function)]
    mine = mine[mine["found_by"] == chosen.found_by]
    sets = pd.concat([best, mine], ignore_index=True)
    return sets.drop_duplicates(["cost_function", "found_by"], ignore_index=True)


def _row(study: Study, e: Estimated) -> dict[str, Any]:
    row: dict[str, Any] = {"fit": STAGES[e.stage], "parameter": e.name}
    # A column that is empty for all parameters is not shown.
    row |= {"name": study.parameters[e.name].label or None, "unit": e.unit}
    row |= {"estimate": e.value, "low": e.low, "high": e.high}
    return row if study.synthetic is None else {**row, "truth": study.synthetic.truth.get(e.name)}


def column_of(row: Mapping[Any, Any]) -> str:
    """Return the heading of a best set."""
    return f"{row['cost_function']} ({row['found_by']})"


def _at_limit(study: Study, name: str, best: pd.DataFrame) -> str:
    """Name the cost functions whose best set has a parameter at a limit."""
    factor = study.parameters[name].factor
    lower, upper = (limit * factor for limit in study.search_limits(name))
    names = dict.fromkeys(
        str(row["cost_function"])
        for row in best.to_dict("records")
        if at_bound(float(row[name]), lower, upper)
    )
    return f"at a limit: {', '.join(names)}" if names else ""


TABLE = Table(
    place=10,
    applies=lambda study: True,
    make=answer,
    title="The answer: estimate, 95 % interval, and the best set of each cost function",
    note="Estimate: the optimum of the likelihood, which weighs each point by its noise. "
    "The 95 % interval holds for a correct model. Best sets: lowest cost of all "
    "optimisers that used this cost; the recommended set has a column as well. Use the values of "
    "one column together, within one part of the table.",
    headings={"low": "95 % low", "high": "95 % high"},
    group_by="fit",
)
