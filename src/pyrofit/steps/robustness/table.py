"""Errors of the cost functions on twins of known truth."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis import groups
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table
from pyrofit.steps.robustness.twins import NOISE, RECOVERED, errors_of_twins


def robustness_table(study: Study, results: Results) -> pd.DataFrame:
    """List the errors by disturbance and cost function.

    Returns
    -------
    pandas.DataFrame
        One row per kind, level and cost function. Its columns are medians over the draws of the
        error of all parameters and of the prediction. The error of each parameter is a root mean
        square in per cent of its limits. The p is Kruskal and Wallis's for errors of the cost
        functions at the same place, Holm-corrected for the number of levels.
    """
    frame = errors_of_twins(study, results)
    names = list(study.imp.estimate)
    rows: list[Row] = []
    for (kind, level, cost), part in frame.groupby(["kind", "level", "cost_function"], sort=False):
        predicted = part["prediction_error"].astype(float)
        rows.append(
            {
                "added": _words(kind, level),
                "cost_function": cost,
                "twins": len(part),
                "error_percent": float(part["error"].median()),
                "prediction_percent": 100.0 * float(predicted.median()),
                **{
                    f"{n} [% of search range]": float(np.sqrt(np.mean(part[n] ** 2))) for n in names
                },
            }
        )
    table = pd.DataFrame(rows)
    order = list(dict.fromkeys(table["added"]))
    table = table.iloc[np.argsort(table["added"].map(order.index), kind="stable")]
    return table.merge(_tests(frame), on="added", how="left")


def _tests(frame: pd.DataFrame) -> pd.DataFrame:
    """Return p of each level, empty with too few twins."""
    words, found = [], []
    for (kind, level), part in frame.groupby(["kind", "level"], sort=False):
        samples = [p["error"].to_numpy(float) for _, p in part.groupby("cost_function")]
        words.append(_words(kind, level))
        found.append(groups.location(samples)[0] if groups.enough(samples) else None)
    known = [p for p in found if p is not None]
    corrected = iter(groups.holm(known))
    p = [None if p is None else next(corrected) for p in found]
    return pd.DataFrame({"added": words, "p": p})


def _words(kind: Any, level: Any) -> str:
    """Return the words for a disturbance.

    >>> _words("noise", 3.0), _words("outliers", 0.05)
    ('noise × 3', 'outliers, 5 % of the points')
    """
    return f"noise × {level:g}" if kind == NOISE else f"outliers, {100.0 * level:g} % of the points"


TABLE = Table(
    place=60,
    make=robustness_table,
    title="Robustness of the cost functions on twins of known truth",
    note="Twins: curves of the model itself with white noise. Its standard deviation is "
    "that of the measurement times the number given. Some twins have outliers as "
    "well, up or down by a share of the signal's range. Fitted by least squares from "
    "random starts. Error: root mean square over the parameters, in per cent of their "
    "limits, median over the twins. Left out are parameters that no cost function "
    f"recovers within {RECOVERED:g} % at the least noise. Prediction: CV(RMSE) of the "
    "mass loss rate at the held-out experiments against the truth. p: Kruskal and "
    "Wallis's test of equal errors of the cost functions, Holm-corrected.",
    headings={
        "cost_function": "cost function",
        "error_percent": "error [% of search range]",
        "prediction_percent": "prediction [%]",
    },
    group_by="added",
)
