"""Which set to predict with, and why, in sentences whose every number comes from the tables."""

import re

import pandas as pd

from pyrofit.config import Study
from pyrofit.report.words import listed, span
from pyrofit.tables.describe import FITTED, HELD_OUT
from pyrofit.tables.determined import WORDS

Frames = dict[str, pd.DataFrame]

_WORSE = 2.0
"""Ratio of the errors held out and fitted from which a prediction is not to be trusted."""


def advice(study: Study, tables: Frames) -> str:
    """Name the best set that fits best, each point weighed by its noise.

    It is chosen by the fit: chosen by its prediction, the held-out data would test it no more.
    """
    distances = tables["distances"]
    columns = [re.fullmatch(r"(.+) \((.+)\)", name) for name in tables["answer"].columns]
    sets = [(m[1], m[2]) for m in columns if m and m[1] in study.imp.costs]
    misfit = {
        (cost, by): float(
            distances[(distances["cost_function"] == cost) & (distances["set"] == f"{by} best")][
                "chi2_per_freedom"
            ].iloc[0]
        )
        for cost, by in sets
    }
    cost, by = min(misfit, key=lambda one: misfit[one])
    least = f"chi-square per degree of freedom {span([misfit[cost, by]])}"
    others = [value for one, value in misfit.items() if one != (cost, by)]
    beside = f", of the others {span(others)}" if others else ""
    text = (
        f"To predict, use the set of {cost} ({by}) as a whole: with each point weighed by its "
        f"noise it fits best of these sets ({least}{beside})"
    )
    return f"{text}{_tested(tables, cost, by)}.{_together(tables)}"


def _tested(tables: Frames, cost: str, by: str) -> str:
    """Say how well it predicts, and what to think of that."""
    if "validation" not in tables:
        return ""
    held, fitted = (_rates(tables, use, cost, by) for use in (HELD_OUT, FITTED))
    if not len(held):
        return "; no mass loss rate was held out to test it"
    text = (
        "; the held-out mass loss rate, by which it was not chosen, it predicts with CV(RMSE) "
        f"{span(held)}"
    )
    if not len(fitted):
        return text
    text += f" and the fitted one with {span(fitted)}"
    if held.max() > _WORSE * fitted.max():
        text += (
            ", so that predictions are not to be trusted before it is known what model or given "
            "values lack (snakemake diagnose)"
        )
    return text


def _rates(tables: Frames, use: str, cost: str, by: str) -> pd.Series:
    """Return CV(RMSE) of a set at the series of a use."""
    table = tables["validation"]
    chosen = (table["cost_function"] == cost) & (table["found_by"] == by) & (table["data"] == use)
    return table[chosen]["cv_rmse"].dropna()


def _together(tables: Frames) -> str:
    """Warn of values that make up for one another, and of those at a limit."""
    table = tables["determined"]
    here = table[table["fit"] == WORDS["imp"]].set_index("parameter")["verdict"]
    bound = here.index[here.str.startswith("at its")].tolist()
    loose = here.index[here.str.contains("undetermined|weakly")].tolist()
    said = ""
    if loose:
        said += (
            f" Do not quote {listed(loose)} alone: other values fit as well, together with other "
            "values of the rest."
        )
    if bound:
        said += f" {listed(bound)} rest{'s' * (len(bound) == 1)} at a limit that the data press on."
    return said
