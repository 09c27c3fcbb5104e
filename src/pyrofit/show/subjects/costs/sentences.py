"""Cost functions compared, in sentences."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.analysis.answer import OutsideAnswer
from pyrofit.analysis.best_predicting import best_predicting, never_fitted, of_answer
from pyrofit.analysis.cost_tests import SIGNIFICANT
from pyrofit.analysis.uses import PUBLISHED, rate_metrics
from pyrofit.config import Study
from pyrofit.results.comparison import ALL
from pyrofit.show.facts import Facts
from pyrofit.show.names import all_scored
from pyrofit.show.table import Frames
from pyrofit.show.text import listed, number, several, span


def reach_of_good_sets(tables: Frames) -> str:
    """Say how far the good sets reach, and which share of the data lies within."""
    table = tables["bands"]
    names = table["cost_function"]
    table = table[names == (ALL if ALL in set(names) else names.iloc[0])]
    parts = [
        f"{row['signal']} at {row['experiment']} {_width(row)} ({row['within_percent']:.0f} % "
        "of the measured points lie inside)"
        for _, row in table.iterrows()
    ]
    return f"Mean width of the predictions of the good sets: {'; '.join(parts)}."


def _width(row: pd.Series) -> str:
    if pd.notna(row["width_percent"]):
        return f"{row['width_percent']:.2g} % of the mean"
    (column,) = (
        str(name)
        for name in row.index
        if str(name).startswith("width") and name != "width_percent" and pd.notna(row[name])
    )
    unit = "K" if column == "width_K" else column.partition("[")[2].rstrip("]")
    return f"{row[column]:.2g} {unit}"


def sentences(study: Study, facts: Facts) -> list[str]:
    """Return the sentences: sets beside the answer, on one metric, by tests, and their reach."""
    said = [*(_beside(one) for one in facts.outside), *_best_predicting(facts)]
    said += [*_metrics(study, facts.tables), *_tests(facts.tables)]
    if "bands" in facts.tables:
        said.append(reach_of_good_sets(facts.tables))
    return [text for text in said if text]


def _beside(one: OutsideAnswer) -> str:
    """Say which values of a best set lie outside the intervals of the answer."""
    name = f"The best set of {one.cost_function} ({one.found_by})"
    if not one.values:
        return f"{name} lies within all intervals of the answer."
    parts = [
        f"{e.name} ({number(value)} against {number(e.low)} to {number(e.high)} {e.unit})"
        for e, value in one.values
    ]
    return (
        f"{name} lies outside the interval of {listed(parts)}. This tells about the cost function; "
        "it is no second answer."
    )


def _best_predicting(facts: Facts) -> list[str]:
    """Say which set of a search predicts held-out tests best, beside the estimates."""
    best = best_predicting(facts.scores)
    if best is None:
        return []
    mine = all_scored(of_answer(never_fitted(facts.scores)))
    return [
        f"Of {several(best.sets, 'set')} of searches, that of {best.cost_function} "
        f"({best.found_by}) predicts the held-out tests best: {all_scored(best.scores)}. The "
        f"estimates predict {mine}. A set that is chosen by these data is not validated by them."
    ]


def _metrics(study: Study, tables: Frames) -> list[str]:
    return [_metric(metric, tables["every_cost"]) for metric in rate_metrics(study)]


def _metric(metric: str, table: pd.DataFrame) -> str:
    """Say whether the cost function or the optimiser matters more on a common metric."""
    parts = []
    for place, rows in table.groupby("place", sort=False):
        ours = rows[rows["found_by"] != PUBLISHED]
        if metric not in ours or ours[metric].isna().all():
            continue
        by_cost = ours.groupby("found_by")[metric].agg(lambda v: v.max() / v.min())
        by_optimiser = ours.groupby("fitted_with")[metric].agg(lambda v: v.max() / v.min())
        parts.append(
            f"{metric} of the best sets at {place} is {span(ours[metric])}. Its ratio of highest "
            f"to lowest is {span(by_cost)} among the cost functions of one optimiser, and "
            f"{span(by_optimiser)} among the optimisers of one cost function."
        )
    return " ".join(parts)


def _tests(tables: Frames) -> list[str]:
    """Say in which quantities the repetitions of the cost functions differ, and by how much."""
    table = tables.get("cost_tests")
    if table is None:
        return []
    if "p_place" not in table:
        return [f"Whether the cost functions differ was {table['verdict'].iloc[0]}."]
    return [_places(table), _scatter(table)]


def _places(table: pd.DataFrame) -> str:
    apart = table[table["p_place"] <= SIGNIFICANT]
    if apart.empty:
        return (
            "The repetitions of the cost functions show no difference in estimates, predictions "
            "and durations (Kruskal and Wallis's test)."
        )
    parts = [_difference(row) for row in apart.to_dict("records")]
    return (
        f"The repetitions of the cost functions differ in {len(apart)} of {len(table)} quantities "
        f"(Kruskal and Wallis's test, Holm-corrected): {'; '.join(parts)}."
    )


def _difference(row: Mapping[Any, Any]) -> str:
    size = f"{number(float(row['difference']))} {row['unit'] if row['unit'] != '-' else ''}".strip()
    text = f"{row['quantity']} (medians {size} apart"
    if pd.notna(row["of_limits"]):
        text += f", {span([row['of_limits']])} % of the search range"
    if pd.notna(row["of_interval"]):
        text += f", {span([row['of_interval']])} % of the 95 % interval"
    return text + ")"


def _scatter(table: pd.DataFrame) -> str:
    apart = list(table.loc[table["p_scatter"] <= SIGNIFICANT, "quantity"])
    if not apart:
        return "No difference in scatter is shown (Brown and Forsythe's test)."
    return f"Their scatter differs in {listed(apart)} (Brown and Forsythe's test)."
