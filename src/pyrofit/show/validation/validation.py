"""Scores of all sets at all predicted experiments."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import predicted_sets, title_of, use_of
from pyrofit.config import Study
from pyrofit.results import prediction
from pyrofit.results.files import Results
from pyrofit.show.table import Table


def validation(study: Study, results: Results) -> pd.DataFrame:
    """Gather the scores of every set: CV(RMSE) of mass loss rates, RMSE [K] of temperatures.

    Returns
    -------
    pandas.DataFrame
        One row per experiment, signal and set; ``data`` says whether the set's cost was fitted to
        the signal or predicts it; ``solver_...`` is the solver's own error, estimated by
        refinement, in the same measure.
    """
    sets = {chosen.label: chosen for chosen in predicted_sets(study)}
    scores = prediction.scores(study, results, list(sets))
    rows: list[dict[str, Any]] = []
    for score in scores.to_dict("records"):
        chosen = sets[score["set"]]
        rate = score["signal"] == "mlr"
        rows.append(
            {
                "experiment": title_of(study, score["experiment"]),
                "signal": score["signal"].replace("_", " ").replace("mlr", "mass loss rate"),
                "cost_function": chosen.cost,
                "found_by": chosen.origin,
                "data": use_of(study, chosen.cost, score["experiment"], score["signal"]),
                "points": score["points"],
                "cv_rmse": score["cv_rmse"] if rate else None,
                "solver_cv_rmse": score["solver_cv_rmse"] if rate else None,
                "rmse_K": None if rate else score["rmse_si"],
                "solver_rmse_K": None if rate else score["solver_rmse_si"],
            }
        )
    frame = pd.DataFrame(rows)
    order = [list(dict.fromkeys(frame[c])).index for c in ("experiment", "signal")]
    key = frame["experiment"].map(order[0]), frame["signal"].map(order[1])
    return frame.iloc[np.lexsort(key[::-1])].reset_index(drop=True)


TABLE = Table(
    place=40,
    applies=lambda study: bool(study.validation.experiments),
    make=validation,
    title="Scores of every set at every predicted experiment",
    note="CV(RMSE) is the RMSE divided by the mean of the measured mass loss rate. 'Held-out "
    "signal': not fitted, though another signal of the same experiment was. 'Solver': the "
    "solver's own error in the same measure, estimated by running again with twice the cells "
    "and half the steps.",
    headings={
        "cost_function": "cost function",
        "found_by": "found by",
        "cv_rmse": "CV(RMSE) [-]",
        "solver_cv_rmse": "solver, CV(RMSE) [-]",
        "rmse_K": "RMSE [K]",
        "solver_rmse_K": "solver, RMSE [K]",
    },
    group_by="experiment",
)
