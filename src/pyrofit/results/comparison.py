"""All sets under all costs, and the bands of the good ones."""

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv

ALL = "all"
"""Name of the band around those of all cost functions."""


def read_all_scores(results: Results) -> pd.DataFrame:
    """Return every end of every optimiser under every measure, a row each."""
    words = ("cost_function", "found_by", "best", "place", "measure", "value")
    columns = {**dict.fromkeys(words, object), "number": float}
    return read_csv(results.comparison("scores.csv"), columns)


def read_bands_of_sets(study: Study, results: Results) -> pd.DataFrame:
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
