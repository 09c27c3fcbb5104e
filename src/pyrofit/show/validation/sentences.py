"""How well sets predict unfitted data, in sentences."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.analysis.scores import Score, by_signal
from pyrofit.analysis.uses import FITTED, SCEUA, STARTED, UNKNOWN
from pyrofit.config import Study
from pyrofit.results.comparison import ALL
from pyrofit.show.facts import Facts
from pyrofit.show.names import places_of, scored
from pyrofit.show.table import Frames
from pyrofit.show.text import listed
from pyrofit.show.units import difference, difference_unit


def sentences(study: Study, facts: Facts) -> list[str]:
    """Say how well the sets predict signals outside their fit, and how exact the solver is."""
    if not study.validation.experiments:
        return []
    found = facts.scores
    return [*_predicted(found), _solver(found), reach_of_good_sets(facts.tables)]


def _predicted(found: Sequence[Score]) -> list[str]:
    """Say how well each signal is predicted where it was not fitted."""
    said = []
    for signal, group in by_signal(found).items():
        ours = [score for score in group if score.found_by == SCEUA]
        free = [score for score in ours if score.use not in (FITTED, UNKNOWN)]
        if not free:
            continue
        text = f"SCE-UA's sets predict the {signal} of {places_of(free)} with {scored(free)}"
        fitted = [score for score in ours if score.use == FITTED]
        text += f" (fitted data: {scored(fitted)})" if fitted else ""
        others = [
            f"those of {by} with {scored(theirs)}"
            for by in STARTED
            if (theirs := [s for s in group if s.found_by == by and s.use != FITTED])
        ]
        said.append(f"{', '.join([text, *others])}.")
    return said


def _solver(found: Sequence[Score]) -> str:
    parts = []
    for signal, group in by_signal(found).items():
        quantity, most = group[0].quantity, max(score.solver for score in group)
        if quantity.relative:
            parts.append(f"{100 * most:.2g} % of the mean {signal}")
        else:
            size = float(difference(quantity, most))
            parts.append(f"{size:.2g} {difference_unit(quantity)} of the {signal}")
    return f"The solver's own error, estimated for every curve, is at most {listed(parts)}."


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
