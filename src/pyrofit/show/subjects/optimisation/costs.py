"""Optimisers compared on the same costs."""

import pandas as pd

from pyrofit.analysis.optimisers import comparison
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import searches
from pyrofit.results.files import Results
from pyrofit.show.table import Table


def optimisers_by_cost(study: Study, results: Results) -> pd.DataFrame:
    """Compare SCE-UA with the optimisers that go from several starts on the same costs.

    Returns
    -------
    pandas.DataFrame
        One row per cost function; model calls are those of all repetitions and of all starts.
    """
    searched = searches.read(study, results, OPTIMISERS)
    every = searched.repetitions
    rows = []
    for cost in study.imp.costs:
        descent = searches.end_of_descent(results, cost).cost
        group = every[every["cost_function"] == cost]
        row = comparison(group, searched.starts[cost], descent)
        rows.append({"cost_function": cost, **row})
    return pd.DataFrame(rows)


_HEADINGS = {
    f"{key}_{column}": words.format(optimiser.words)
    for key, optimiser in OPTIMISERS.items()
    for column, words in {
        "starts": "random starts of {}",
        "starts_at_best": "of these within 1 % of its best",
        "best": "{} best",
        "calls": "{} model calls",
        "at_bound": "{} at a limit",
    }.items()
}


TABLE = Table(
    place=10,
    make=optimisers_by_cost,
    title="Optimisers compared on the same costs",
    note="Model calls are those of all repetitions, and of all starts. The ratio is the "
    "lowest cost of the others over the best of SCE-UA. 'From SCE-UA's best': end of "
    "least squares started there. If it is lower, SCE-UA did not reach a minimum. The "
    "solver's error is 4/3 of the change with twice the cells and half the steps. 'At "
    "bound': within 0.5 % of the search range.",
    headings={
        "cost_function": "cost function",
        "sceua_best": "SCE-UA best",
        "sceua_best_solver_error": "solver's error in it",
        "sceua_mean": "SCE-UA mean",
        "sceua_at_lowest": "repetitions within 1 % of the lowest cost of all",
        "sceua_calls": "SCE-UA model calls",
        "sceua_failed_calls": "failed calls",
        "least_squares_from_sceua": "least squares from SCE-UA's best",
        **_HEADINGS,
        "lowest_by": "the lower of the two",
    },
    upright="cost_function",
)
