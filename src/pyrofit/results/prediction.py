"""Predicted curves and their scores."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.config import Study
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.results.files import Results, read_csv
from pyrofit.results.needed import Keys


def read_predicted_curves(study: Study, results: Results, labels: Sequence[str]) -> pd.DataFrame:
    """Return the curves of the labelled sets at the predicted experiments."""
    return read_csv(
        results.validation("curves.csv"),
        dict.fromkeys(("time_s", "simulated", "measured"), float),
        _rows(study, labels),
    )


def read_scores(study: Study, results: Results, labels: Sequence[str]) -> pd.DataFrame:
    """Return the scores of the labelled sets at the predicted experiments."""
    return read_csv(
        results.validation("scores.csv"),
        {
            **dict.fromkeys(("points", "rmse_si", "solver_rmse_si"), float),
            **dict.fromkeys(("cv_rmse", "solver_cv_rmse"), object),
        },
        _rows(study, labels),
    )


def unmeasured_curves(study: Study, results: Results, labels: Sequence[str]) -> pd.DataFrame:
    """Return the curves of the labelled sets for unmeasured quantities."""
    rows: list[Keys] = [
        (name, quantity, label)
        for name, quantities in unmeasured(study).items()
        for quantity in quantities
        for label in labels
    ]
    numbers = dict.fromkeys(("time_s", "simulated"), float)
    return read_csv(
        results.validation("unmeasured.csv"), numbers, {("experiment", "signal", "set"): rows}
    )


def _rows(study: Study, labels: Sequence[str]) -> dict[Keys, list[Keys]]:
    rows: list[Keys] = [
        (name, signal, label)
        for name in study.validation.experiments
        for signal in study.experiments[name].signals
        for label in labels
    ]
    return {("experiment", "signal", "set"): rows}
