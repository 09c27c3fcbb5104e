"""Scores of all sets at all predicted experiments."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.analysis.scores import Score, scores_of_sets
from pyrofit.analysis.uses import predicted_labels
from pyrofit.config import Study
from pyrofit.quantities.base import Quantity
from pyrofit.results import prediction
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table
from pyrofit.show.units import unit_cells


def validation(study: Study, results: Results) -> pd.DataFrame:
    """Gather the scores of every set: CV(RMSE) of rates, RMSE of all else.

    Returns
    -------
    pandas.DataFrame
        One row per experiment, signal and set. ``data`` says whether the set's cost was fitted to
        the signal or predicts it. ``solver_...`` is the solver's own error, estimated by
        refinement, in the same measure.
    """
    found = scores_of_sets(study, prediction.read_scores(study, results, predicted_labels(study)))
    among = [score.quantity for score in found]
    return pd.DataFrame([_row(score, among) for score in found])


def _row(score: Score, among: Sequence[Quantity]) -> Row:
    rate = score.quantity.relative
    return {
        "experiment": score.experiment,
        "signal": score.signal,
        "cost_function": score.cost_function,
        "found_by": score.found_by,
        "data": score.use,
        "points": score.points,
        "cv_rmse": score.value if rate else None,
        "solver_cv_rmse": score.solver if rate else None,
        **unit_cells("rmse", score.quantity, score.value, among),
        **unit_cells("solver_rmse", score.quantity, score.solver, among),
    }


TABLE = Table(
    place=40,
    applies=lambda study: bool(study.validation.experiments),
    make=validation,
    title="Scores of every set at every predicted experiment",
    note="CV(RMSE) of a rate is the RMSE divided by the mean of its measured values. 'Held-out "
    "signal': not fitted, though another signal of the same experiment was. 'Solver': the "
    "solver's own error in the same measure, estimated by running again with twice the cells "
    "and half the steps.",
    headings={
        "cost_function": "cost function",
        "found_by": "found by",
        "cv_rmse": "CV(RMSE) [-]",
        "solver_cv_rmse": "solver, CV(RMSE) [-]",
        "rmse_K": "RMSE [K]",
        "rmse": "RMSE",
        "solver_rmse_K": "solver, RMSE [K]",
        "solver_rmse": "solver, RMSE",
    },
    group_by="experiment",
)
