"""Width of the predictions of the good sets."""

import pandas as pd

from pyrofit.analysis.good_sets import GOOD, MOST
from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities import known_quantities
from pyrofit.results import recorded
from pyrofit.results.comparison import bands
from pyrofit.results.files import Results, read_csv
from pyrofit.show.table import Table
from pyrofit.solver.arrays import FloatArray

WORDS = {"mlr": "mass loss rate", "back_temperature": "back temperature"}


def width_of_bands(study: Study, results: Results) -> pd.DataFrame:
    """Say how wide the predictions of the good sets are, and what of the data lies within.

    Returns
    -------
    pandas.DataFrame
        One row per experiment, signal and cost function, and one for all of these together. Width:
        mean over time, in per cent of the mean of the measured mass loss rate, or in K. Within: per
        cent of the measured points inside the band, and inside the band widened by their stated
        uncertainty.
    """
    frame = bands(study, results)
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


TABLE = Table(
    place=60,
    applies=lambda study: True,
    make=width_of_bands,
    title="What the good sets predict",
    note=f"Good sets: those whose cost is at most {GOOD:g} of the lowest known one, met on a "
    f"random walk from there within the limits; simulated are at most {MOST} for each cost "
    "function, those that lie farthest apart. Width: highest minus lowest "
    "prediction, mean over time. Within: share of the measured points inside the band, and "
    "inside the band widened by their stated uncertainty. The band is the reach of the good "
    "sets, not an interval of a probability.",
    headings={
        "cost_function": "cost function",
        "good_sets": "good sets",
        "width_percent": "width [% of mean]",
        "width_K": "width [K]",
        "within_percent": "points within [%]",
        "within_with_uncertainty_percent": "with their uncertainty [%]",
    },
    group_by="experiment",
)
