"""The summary of a report: sentences whose every number comes from the results."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pandas as pd

from pyrofit.config import Study
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


def summary(study: Study, tables: Frames) -> list[str]:
    """Return about five sentences; ``tables`` are the study's tables by name."""
    parts: list[Callable[[Study, Frames], str]] = [
        _data,
        _kinetics,
        _fit,
        _optimisers,
        _parameters,
        _validation,
        _back_temperature,
        _solver,
    ]
    return [text for part in parts if (text := part(study, tables))]


def listed(words: Sequence[str]) -> str:
    """Join words as in a sentence.

    >>> listed(["a", "b", "c"])
    'a, b and c'
    """
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def span(values: Sequence[float] | pd.Series) -> str:
    """Write the smallest and the largest of some numbers.

    >>> span([0.38129, 0.35265])
    '0.353 to 0.381'
    >>> span([19.0, 100.2])
    '19.0 to 100'
    """
    low, high = (f"{value:#.3g}".rstrip(".") for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def _data(study: Study, tables: Frames) -> str:
    used = fitted_experiments(study)
    fitted = listed([title_of(study, name) for name in study.experiments if name in used])
    rest = [n for n in study.validation.experiments if n not in used]
    held = listed([title_of(study, name) for name in rest])
    runs = study.imp.repetitions
    return (
        f"{len(study.imp.estimate)} parameters were fitted to {fitted} with "
        f"{len(study.imp.costs)} cost function{_s(len(study.imp.costs))} and {runs} "
        f"repetition{_s(runs)} each" + (f"; {held} was held out." if held else ".")
    )


def _s(count: int) -> str:
    return "" if count == 1 else "s"


def _kinetics(study: Study, tables: Frames) -> str:
    if study.kinetics is None:
        return ""
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
    for label in study.kinetics.sets:
        text += f"; the published set '{label}' by {span(rows[label])} at all rates"
    return text + "."


def _fit(study: Study, tables: Frames) -> str:
    fits = tables["table4"][tables["table4"]["quantity"] == "fit"]
    parts = []
    for row in fits.to_dict("records"):
        theirs = row.get("published_best")
        beside = "" if theirs is None or pd.isna(theirs) else f" (published {number(theirs)})"
        parts.append(f"{number(row['best'])} for {row['cost_function']}{beside}")
    return f"The lowest costs that SCE-UA found are {listed(parts)}."


def _optimisers(study: Study, tables: Frames) -> str:
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
    text = f"On the same costs other optimisers go lower: {listed(parts)}"
    if stuck:
        text += f"; SCE-UA stopped at a local optimum for {_costs(stuck)}"
    if short:
        text += f"; SCE-UA had not converged for {_costs(short)}: least squares goes on from there"
    return text + "."


def _costs(rows: Sequence[Mapping[Any, Any]]) -> str:
    return listed([str(row["cost_function"]) for row in rows])


def _parameters(study: Study, tables: Frames) -> str:
    table = tables["table4"]
    bound = _flagged(table, "at bound")
    wide = _flagged(table, "spread")
    if not bound and not wide:
        once = "" if table["sigma"].notna().any() else " (no spread from one repetition)"
        return f"No best set is at a limit, no spread above 20 % of the limits{once}."
    parts = [f"at a limit: {bound}"] if bound else []
    parts += [f"not determined (spread above 20 % of the limits): {wide}"] if wide else []
    return f"Parameters not to rely on: {'; '.join(parts)}."


def _flagged(table: pd.DataFrame, word: str) -> str:
    found = table[table["flags"].str.contains(word, regex=False)]
    names = found.groupby("quantity", sort=False)["cost_function"].agg(", ".join)
    return ", ".join(f"{name} ({costs})" for name, costs in names.items())


def _validation(study: Study, tables: Frames) -> str:
    if "validation" not in tables:
        return ""
    scores = tables["validation"].dropna(subset=["cv_rmse"])
    held = scores[scores["data"] == HELD_OUT]
    ours, squares = (held[held["found_by"] == who]["cv_rmse"] for who in (SCEUA, LEAST_SQUARES))
    if not len(ours):
        return ""
    fitted = scores[(scores["data"] == "fitted") & (scores["found_by"] == SCEUA)]["cv_rmse"]
    where = listed(list(dict.fromkeys(held["experiment"])))
    text = f"The mass loss rate of {where}, not fitted, is predicted with CV(RMSE) {span(ours)}"
    text += f" (fitted data: {span(fitted)})" if len(fitted) else ""
    return text + f"; the sets of least squares predict it with {span(squares)}."


def _back_temperature(study: Study, tables: Frames) -> str:
    if not predicted(study, "back_temperature"):
        return ""
    scores = tables["validation"].dropna(subset=["rmse_K"])
    scores = scores[(scores["found_by"] == SCEUA) & (scores["data"] != "fitted")]
    parts = [
        f"{span(part['rmse_K'])} K at {name}"
        for name, part in scores.groupby("experiment", sort=False)
    ]
    return f"Back temperatures, not fitted, are missed by {listed(parts)} (RMSE)." if parts else ""


def _solver(study: Study, tables: Frames) -> str:
    if "validation" not in tables:
        return ""
    scores = tables["validation"]
    rate, kelvin = scores["solver_cv_rmse"].max(), scores["solver_rmse_K"].max()
    parts = [f"{100 * rate:.2g} % of the mean mass loss rate"] if pd.notna(rate) else []
    parts += [f"{kelvin:.2g} K"] if pd.notna(kelvin) else []
    return f"The solver's own error, estimated for every curve, is at most {listed(parts)}."
