"""Optimisers and cost functions compared, in sentences whose every number comes from results."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.quantities import known_quantities
from pyrofit.report import remarks
from pyrofit.report.words import listed, span
from pyrofit.results.files import Results, read_csv
from pyrofit.stages.compare import FITTED
from pyrofit.tables.comparison import ALL
from pyrofit.tables.describe import CMAES, LEAST_SQUARES, PUBLISHED, SCEUA
from pyrofit.tables.differences import SIGNIFICANT
from pyrofit.tables.robustness import errors, recovered
from pyrofit.tables.text import number

Frames = dict[str, pd.DataFrame]

_BENCHMARKS = {SCEUA: "imp_{}_??", LEAST_SQUARES: "least_squares_{}", CMAES: "cmaes_{}"}


def optimisers(study: Study, results: Results, tables: Frames) -> list[str]:
    """Return the sentences on the optimisers: who is ahead, and times."""
    said = [remarks.optimisers(tables), _beaten(tables), _times(study, results)]
    return [text for text in said if text]


def costs(tables: Frames) -> list[str]:
    """Return the sentences on the cost functions: on one metric, and by tests."""
    return [text for text in (_metric(tables), *_tests(tables)) if text]


def _beaten(tables: Frames) -> str:
    """Say where a set fitted with another cost function is the best under a cost function."""
    table = tables["every_cost"]
    fitted = table[table["place"] == FITTED]
    parts = []
    for cost in dict.fromkeys(fitted["fitted_with"]):
        own = fitted[(fitted["fitted_with"] == cost) & (fitted["found_by"] != PUBLISHED)][
            cost
        ].min()
        lowest = fitted.loc[fitted[cost].idxmin()]
        if lowest[cost] < 0.99 * own:
            parts.append(
                f"under {cost} the set fitted with {lowest['fitted_with']} by "
                f"{lowest['found_by']} has {number(float(lowest[cost]))}, those fitted with {cost} "
                f"{number(float(own))} at best"
            )
    if not parts:
        return "Under no cost function is a set lower by 1 % than those that were fitted with it."
    return f"A search may miss what another one finds: {'; '.join(parts)}."


def _metric(tables: Frames) -> str:
    """Say whether the cost function or the optimiser matters more on the common metric."""
    metric = known_quantities()["mlr"].metric
    table = tables["every_cost"]
    parts = []
    for place, rows in table.groupby("place", sort=False):
        ours = rows[rows["found_by"] != PUBLISHED]
        if metric not in ours or ours[metric].isna().all():
            continue
        by_cost = ours.groupby("found_by")[metric].agg(lambda v: v.max() / v.min())
        by_optimiser = ours.groupby("fitted_with")[metric].agg(lambda v: v.max() / v.min())
        parts.append(
            f"at {place} {span(ours[metric])}: highest over lowest is {span(by_cost)} among the "
            f"cost functions of one optimiser, {span(by_optimiser)} among the optimisers of one "
            "cost function"
        )
    return f"CV(RMSE) of the mass loss rate of the best sets {'; '.join(parts)}." if parts else ""


def _tests(tables: Frames) -> list[str]:
    """Say in what the repetitions of the cost functions differ, and by how much."""
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
            "Over the repetitions the cost functions show no difference in where the searches end, "
            "what their sets predict, and how long they take (Kruskal and Wallis's test)."
        )
    parts = [_difference(row) for row in apart.to_dict("records")]
    rest = len(table) - len(apart)
    return (
        f"Over the repetitions the cost functions differ in {listed(parts)}; in the other {rest} "
        "quantities no difference is shown (Kruskal and Wallis's test, Holm-corrected)."
    )


def _difference(row: Mapping[Any, Any]) -> str:
    size = f"{number(float(row['difference']))} {row['unit'] if row['unit'] != '-' else ''}".strip()
    text = f"{row['quantity']} (medians {size} apart"
    if pd.notna(row["of_limits"]):
        text += f", {span([row['of_limits']])} % of the limits"
    if pd.notna(row["of_interval"]):
        text += f", {span([row['of_interval']])} % of the 95 % interval"
    return text + ")"


def _scatter(table: pd.DataFrame) -> str:
    apart = list(table.loc[table["p_scatter"] <= SIGNIFICANT, "quantity"])
    if not apart:
        return "No difference in scatter is shown (Brown and Forsythe's test)."
    return f"They scatter differently in {listed(apart)} (Brown and Forsythe's test)."


def good_sets(tables: Frames) -> str:
    """Say how far the good sets reach, and what of the data they reach."""
    table = tables["bands"]
    names = table["cost_function"]
    table = table[names == (ALL if ALL in set(names) else names.iloc[0])]
    parts = []
    for row in table.to_dict("records"):
        wide = (
            f"{row['width_percent']:.2g} % of the mean"
            if pd.notna(row["width_percent"])
            else f"{row['width_K']:.2g} K"
        )
        parts.append(
            f"{row['signal']} at {row['experiment']} {wide}, {row['within_percent']:.0f} % of the "
            "measured points inside"
        )
    return f"Mean width of what the good sets predict: {'; '.join(parts)}."


def _times(study: Study, results: Results) -> str:
    """Say the wall times, where the workflow has measured them all."""
    parts = []
    for by, pattern in _BENCHMARKS.items():
        files = [
            path
            for cost in study.imp.costs
            for path in sorted((results.root / "benchmarks").glob(f"{pattern.format(cost)}.tsv"))
        ]
        if not files:
            return ""
        seconds = sum(float(path.read_text().splitlines()[-1].split("\t")[0]) for path in files)
        parts.append(f"{by} {seconds:.0f} s in {len(files)} job{'s' if len(files) > 1 else ''}")
    return f"Wall times of this run, all cost functions: {', '.join(parts)}."


def robustness(study: Study, results: Results) -> list[str]:
    """Return the sentences on the twins of known truth."""
    table = read_csv(results.robustness("table.csv"))
    found = errors(study, results)
    kept = recovered(study, found)
    lost = [name for name in study.imp.estimate if name not in kept]
    said = []
    for added, rows in table.groupby("added", sort=False):
        sizes = rows.set_index("cost_function")["error_percent"]
        text = ", ".join(f"{cost} {size:.2g} %" for cost, size in sizes.items())
        p = rows["p"].iloc[0]
        said.append(f"{added}: {text}" + (f", {_apart(p)}" if pd.notna(p) else ""))
    left = f" without {listed(lost)}, which no cost function recovers" if lost else ""
    return [f"Median error of the parameters in per cent of their limits{left}. {'; '.join(said)}."]


def _apart(p: float) -> str:
    return f"{'they differ' if p <= SIGNIFICANT else 'no difference shown'} (p = {p:.2g})"
