"""What was fitted to which data, and which values are unreliable, in sentences."""

import pandas as pd

from pyrofit.analysis.uses import fitted_experiments, title_of
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Frames
from pyrofit.show.text import listed, number, several


def sentences(study: Study, results: Results, tables: Frames) -> list[str]:
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
