"""Every cost with its best stored set, and how good that is under the others."""

import pandas as pd

from pyrofit.analysis.rescoring import VALLEY
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table
from pyrofit.steps.rescore import record
from pyrofit.steps.rescore.facts import in_study_units, of_shown


def best_table(study: Study, results: Results) -> pd.DataFrame:
    """List the costs, each with its best stored set."""
    found = record.read(study, results)
    same = {name: group[0] for group in found.same for name in group[1:]}
    return pd.DataFrame([_row(study, measure, same) for measure in found.measures])


def _row(study: Study, measure: record.OfMeasure, same: dict[str, str]) -> Row:
    values = in_study_units(study, measure.parameters.items())
    return {
        "cost": measure.name,
        "what": measure.words,
        "ranks_as": same.get(measure.name, "" if measure.tells_apart else "tells no sets apart"),
        "value": measure.value,
        "fitted_with": measure.fitted_with,
        **values,
    }


def excess_table(study: Study, results: Results) -> pd.DataFrame:
    """List how much higher the best set of each cost is under the others, in per cent."""
    table = of_shown(record.read(study, results), record.matrix(results, record.EXCESS))
    return (100.0 * table).rename_axis("best_of").reset_index()


def rank_correlation_table(study: Study, results: Results) -> pd.DataFrame:
    """List Spearman's rank correlation of all costs."""
    table = record.matrix(results, record.CORRELATION)
    return of_shown(record.read(study, results), table).reset_index()


def valleys_table(study: Study, results: Results) -> pd.DataFrame:
    """List where the valley of each cost lies, per cent of the search range."""
    found = record.read(study, results)
    rows = [
        {
            "cost": measure.name,
            "sets": measure.valley_sets,
            "parameter": name,
            "low": 100.0 * at.low,
            "best": 100.0 * at.best,
            "high": 100.0 * at.high,
        }
        for measure in found.measures
        for name, at in measure.valley.items()
    ]
    return pd.DataFrame(rows)


TABLES = {
    "best": Table(
        place=60,
        make=best_table,
        title="Best stored set of every cost",
        note="Lowest of all stored sets that were scored, whatever they were fitted with. 'Ranks "
        "as': the cost puts all sets in the same order as the one named.",
        headings={
            "what": "what it is",
            "ranks_as": "ranks as",
            "fitted_with": "found by the search with",
        },
    ),
    "rank_correlation": Table(
        place=70,
        make=rank_correlation_table,
        title="Rank correlation of the costs over the stored sets",
        note="Spearman's correlation. Costs that rank as another one are left out.",
        shown=False,
    ),
    "regret": Table(
        place=80,
        make=excess_table,
        title="The stored set with the lowest value of one cost, under another cost",
        note="Excess over the lowest value of the cost in the column, in per cent of that value. "
        "Empty where that is 0.",
        headings={"best_of": "best set of"},
        shown=False,
    ),
    "valleys": Table(
        place=90,
        make=valleys_table,
        title="Where the valley of every cost lies",
        note=f"Range of each parameter over the best {100.0 * VALLEY:g} % of the sets of a cost, "
        "and the set with its lowest value. Both in per cent of the search range.",
        group_by="cost",
        shown=False,
    ),
}
