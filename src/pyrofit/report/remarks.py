"""What sections say beside their tables: sentences whose every number comes from the results."""

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from pyrofit.config import Study
from pyrofit.report.words import listed, several, span
from pyrofit.tables.describe import (
    HELD_OUT,
    LEAST_SQUARES,
    SCEUA,
    all_rates,
    fitted_experiments,
    predicted,
    rates_in_fit,
    title_of,
)
from pyrofit.tables.imp import LOCAL_OPTIMUM, NOT_A_MINIMUM, WORDS
from pyrofit.tables.text import number

Frames = dict[str, pd.DataFrame]


def kinetics(study: Study, tables: Frames) -> list[str]:
    """Say how well the kinetics reproduce the mass."""
    assert study.kinetics is not None
    rows = tables["table3"][tables["table3"]["quantity"] == "RMSE of mass fraction"]
    used = rows[rows["used_in_fit"] == "yes"]
    other = rows[rows["used_in_fit"] == "no"]
    fitted, every = len(rates_in_fit(study)), len(all_rates(study))
    text = (
        f"The kinetics, fitted to {fitted} of {every} heating rates, miss the mass fraction there "
        f"by {span(used['fitted'])} (RMSE)"
    )
    if len(other):
        text += f", and by {span(other['fitted'])} at the others"
    said = [f"{text}."]
    said += [
        f"The published set '{label}' misses it by {span(rows[label])} at all rates."
        for label in study.kinetics.sets
    ]
    return said


def fit(study: Study, tables: Frames) -> list[str]:
    """Say what was fitted to what, how low the costs are, and which values not to rely on."""
    return [_data(study), _lowest(tables), _parameters(tables)]


def _data(study: Study) -> str:
    used = fitted_experiments(study)
    fitted = listed([title_of(study, name) for name in study.experiments if name in used])
    held = listed([title_of(study, n) for n in study.validation.experiments if n not in used])
    text = (
        f"{several(len(study.imp.estimate), 'parameter')} fitted to {fitted}, with "
        f"{several(len(study.imp.costs), 'cost function')} and "
        f"{several(study.imp.repetitions, 'repetition')} each"
    )
    return f"{text}; held out: {held}." if held else f"{text}."


def _lowest(tables: Frames) -> str:
    fits = tables["table4"][tables["table4"]["quantity"] == "fit"]
    parts = []
    for row in fits.to_dict("records"):
        theirs = row.get("published_best")
        beside = "" if theirs is None or pd.isna(theirs) else f" (published {number(theirs)})"
        parts.append(f"{number(row['best'])} for {row['cost_function']}{beside}")
    return f"The lowest costs that SCE-UA found are {listed(parts)}."


def _parameters(tables: Frames) -> str:
    table = tables["table4"]
    bound = _flagged(table, "at bound")
    wide = _flagged(table, "spread")
    if not bound and not wide:
        once = "" if table["sigma"].notna().any() else " (no spread from one repetition)"
        return f"No best set is at a limit, no spread above 20 % of the limits{once}."
    parts = [f"at a limit: {bound}"] if bound else []
    parts += [f"scattered (spread above 20 % of the limits): {wide}"] if wide else []
    return f"Of SCE-UA's sets not to rely on: {'; '.join(parts)}."


def _flagged(table: pd.DataFrame, word: str) -> str:
    found = table[table["flags"].str.contains(word, regex=False)]
    names = found.groupby("quantity", sort=False)["cost_function"].agg(", ".join)
    return ", ".join(f"{name} ({costs})" for name, costs in names.items())


def optimisers(tables: Frames) -> str:
    """Say for which cost functions another optimiser gets lower than SCE-UA, and how surely."""
    rows = tables["costs"].to_dict("records")
    stuck = [r for r in rows if r["remark"] == LOCAL_OPTIMUM]
    short = [r for r in rows if r["remark"] == NOT_A_MINIMUM]
    if not stuck and not short:
        return "Least squares and CMA-ES from random starts found no cost lower by more than 1 %."
    parts = []
    for r in stuck + short:
        name = r["lowest_by"]
        by = next(key for key, word in WORDS.items() if word == name)
        bound = f" ({r[f'{by}_at_bound']} at a limit)" if r[f"{by}_at_bound"] else ""
        agree = f"{r[f'{by}_starts_at_best']} of {r[f'{by}_starts']} starts of {name} agree"
        parts.append(f"{r['cost_function']} by {100 * (1 - r['ratio']):.0f} %, {agree}{bound}")
    text = f"On the same costs other optimisers go lower: {'; '.join(parts)}"
    if stuck:
        text += f". SCE-UA stopped at a local optimum for {costs_of(stuck)}"
    if short:
        text += f". SCE-UA had not converged for {costs_of(short)}: least squares goes on there"
    return text + "."


def costs_of(rows: Sequence[Mapping[Any, Any]]) -> str:
    """List the cost functions of some rows."""
    return listed([str(row["cost_function"]) for row in rows])


def validation(study: Study, tables: Frames) -> list[str]:
    """Say how well the sets predict what they were not fitted to, and how exact the solver is."""
    if "validation" not in tables:
        return []
    said = [_rates(tables["validation"]), _back_temperature(study, tables), _solver(tables)]
    return [text for text in said if text]


def _rates(table: pd.DataFrame) -> str:
    scores = table.dropna(subset=["cv_rmse"])
    held = scores[scores["data"] == HELD_OUT]
    ours, squares = (held[held["found_by"] == who]["cv_rmse"] for who in (SCEUA, LEAST_SQUARES))
    if not len(ours):
        return ""
    fitted = scores[(scores["data"] == "fitted") & (scores["found_by"] == SCEUA)]["cv_rmse"]
    where = listed(list(dict.fromkeys(held["experiment"])))
    text = f"SCE-UA's sets predict the mass loss rate of {where} with CV(RMSE) {span(ours)}"
    text += f" (fitted data: {span(fitted)})" if len(fitted) else ""
    return f"{text}, those of least squares with {span(squares)}."


def _back_temperature(study: Study, tables: Frames) -> str:
    if not predicted(study, "back_temperature"):
        return ""
    scores = tables["validation"].dropna(subset=["rmse_K"])
    scores = scores[(scores["found_by"] == SCEUA) & (scores["data"] != "fitted")]
    parts = [
        f"{span(part['rmse_K'])} K at {name}"
        for name, part in scores.groupby("experiment", sort=False)
    ]
    return f"They miss back temperatures, not fitted, by {listed(parts)} (RMSE)." if parts else ""


def _solver(tables: Frames) -> str:
    scores = tables["validation"]
    rate, kelvin = scores["solver_cv_rmse"].max(), scores["solver_rmse_K"].max()
    parts = [f"{100 * rate:.2g} % of the mean mass loss rate"] if pd.notna(rate) else []
    parts += [f"{kelvin:.2g} K"] if pd.notna(kelvin) else []
    return f"The solver's own error, estimated for every curve, is at most {listed(parts)}."
