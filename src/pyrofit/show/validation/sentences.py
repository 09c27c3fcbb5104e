"""How well sets predict unfitted data, in sentences."""

import pandas as pd

from pyrofit.analysis.uses import HELD_OUT, LEAST_SQUARES, SCEUA, predicted
from pyrofit.config import Study
from pyrofit.results.comparison import ALL
from pyrofit.results.files import Results
from pyrofit.show.table import Frames
from pyrofit.show.text import listed, span


def sentences(study: Study, results: Results, tables: Frames) -> list[str]:
    """Say how well the sets predict what they were not fitted to, and how exact the solver is."""
    if "validation" not in tables:
        return []
    said = [_rates(tables["validation"]), _back_temperature(study, tables), _solver(tables)]
    said.append(reach_of_good_sets(tables))
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


def reach_of_good_sets(tables: Frames) -> str:
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
