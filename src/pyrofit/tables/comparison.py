"""Every best set under every cost, and what good sets predict."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.quantities import known_quantities
from pyrofit.results import recorded
from pyrofit.results.files import Results, read_csv
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.compare import FITTED
from pyrofit.tables.describe import title_of

WORDS = {"mlr": "mass loss rate", "back_temperature": "back temperature"}
ALL = "all"
"""Name of the band around those of all cost functions."""


def scores(results: Results) -> pd.DataFrame:
    """Return every end of every optimiser under every measure, a row each."""
    words = ("cost_function", "found_by", "best", "place", "measure", "value")
    columns = {**dict.fromkeys(words, object), "number": float}
    return read_csv(results.comparison("scores.csv"), columns)


def every_cost(study: Study, results: Results) -> pd.DataFrame:
    """Set every best set under every cost and on the common metric, by place.

    Returns
    -------
    pandas.DataFrame
        One row per place and best set; a column for each cost function of the study and each
        metric, empty where it cannot be computed.
    """
    found = scores(results)
    best = found[found["best"]]
    rows: dict[tuple[str, str, str], dict[str, Any]] = {}
    for row in best.to_dict("records"):
        key = row["place"], row["cost_function"], row["found_by"]
        place = FITTED if row["place"] == FITTED else title_of(study, row["place"])
        about = {"place": place, "fitted_with": row["cost_function"], "found_by": row["found_by"]}
        rows.setdefault(key, about)[row["measure"]] = row["value"]
    frame = pd.DataFrame(list(rows.values()))
    predicted = [study.experiments[name] for name in study.validation.experiments]
    metrics = dict.fromkeys(e.metric(signal) for e in predicted for signal in e.signals)
    measures = [*study.imp.costs, *metrics]
    return frame[["place", "fitted_with", "found_by", *(m for m in measures if m in frame)]]


def bands(study: Study, results: Results) -> pd.DataFrame:
    """Say how wide the predictions of the good sets are, and what of the data lies within.

    Returns
    -------
    pandas.DataFrame
        One row per experiment, signal and cost function, and one for all of these together. Width:
        mean over time, in per cent of the mean of the measured mass loss rate, or in K. Within: per
        cent of the measured points inside the band, and inside the band widened by their stated
        uncertainty.
    """
    frame = band_curves(study, results)
    met = read_csv(results.comparison("family.csv"), {"met": float}).groupby("cost_function")["met"]
    tried = met.first().astype(int).to_dict()
    rows = []
    for (name, signal, cost), part in frame.groupby(
        ["experiment", "signal", "cost_function"], sort=False
    ):
        measured = recorded.series(study, results, str(name), str(signal))
        margin = measured.get(known_quantities()[str(signal)].uncertainty_column)
        rate = signal == "mlr"
        width = float((part["high"] - part["low"]).mean())
        rows.append(
            {
                "experiment": title_of(study, str(name)),
                "signal": WORDS[str(signal)],
                "cost_function": cost,
                "good_sets": tried.get(str(cost), sum(tried.values())),
                "simulated": int(part["sets"].iloc[0]),
                "width_percent": 100.0 * width / abs(part["measured"].mean()) if rate else None,
                "width_K": None if rate else width,
                "within_percent": _within(part, 0.0),
                "within_with_uncertainty_percent": (
                    None if margin is None else _within(part, margin.to_numpy(float))
                ),
            }
        )
    return pd.DataFrame(rows)


def _within(part: pd.DataFrame, margin: FloatArray | float) -> float:
    inside = (part["measured"] >= part["low"] - margin) & (
        part["measured"] <= part["high"] + margin
    )
    return 100.0 * float(inside.mean())


def band_curves(study: Study, results: Results) -> pd.DataFrame:
    """Return the bands of each cost function, and `ALL` around them, SI units."""
    rows = [(cost,) for cost in study.imp.costs]
    numbers = ("time_s", "measured", "best", "low", "high", "sets")
    frame = read_csv(
        results.comparison("bands.csv"),
        {"experiment": object, "signal": object, **dict.fromkeys(numbers, float)},
        {("cost_function",): rows},
    )
    parts = []
    for _, channel in frame.groupby(["experiment", "signal"], sort=False):
        by_cost = [part for _, part in channel.groupby("cost_function", sort=False)]
        parts += by_cost
        if len(by_cost) > 1:
            parts.append(
                by_cost[0].assign(
                    cost_function=ALL,
                    low=np.min([p["low"] for p in by_cost], axis=0),
                    high=np.max([p["high"] for p in by_cost], axis=0),
                    sets=sum(p["sets"].iloc[0] for p in by_cost),
                )
            )
    return pd.concat(parts, ignore_index=True)
