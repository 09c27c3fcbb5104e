"""How well the kinetics and heats reproduce heat flow and heat release."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import kinetics
from pyrofit.results.files import Results
from pyrofit.results.kinetics import heats_shown
from pyrofit.show.subjects.kinetics.drawing import rate_of
from pyrofit.show.table import Row, Table


def heat_scores(study: Study, results: Results) -> pd.DataFrame:
    """Return the RMSE of every signal other than mass, one column per set.

    Returns
    -------
    pandas.DataFrame
        One row per signal; columns ``quantity``, ``of``, ``unit``, ``used_in_fit``, ``fitted`` and
        one per published set.
    """
    rows_of_file = kinetics.read_heat_scores(study, results).to_dict("records")
    scores = {(row["experiment"], row["signal"], row["set"]): row for row in rows_of_file}
    rows: list[Row] = []
    for name, signal in heats_shown(study):
        shown = study.experiments[name].quantity(signal).shown
        found = {label: scores[name, signal, label] for label in kinetics.labels(study)}
        used = any(bool(score["used_in_fit"]) for score in found.values())
        rows.append(
            {
                "quantity": f"RMSE of {study.experiments[name].words(signal)}",
                "of": f"{rate_of(study, name)}, {name}",
                "unit": shown.unit,
                "used_in_fit": "yes" if used else "no",
                **{label: float(score["rmse"]) * shown.factor for label, score in found.items()},
            }
        )
    return pd.DataFrame(rows)


TABLE = Table(
    place=50,
    applies=lambda study: bool(heats_shown(study)),
    make=heat_scores,
    title="How well heat flow and heat release are reproduced",
    note="The RMSE is over all measured points. Published sets contain kinetics only; heats, "
    "specific heats and baselines are those of our fit.",
    headings={"used_in_fit": "used in fit"},
)
