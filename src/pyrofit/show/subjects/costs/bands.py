"""Width of the predictions of the good sets."""

from collections.abc import Sequence

import pandas as pd

from pyrofit.analysis.good_sets import GOOD, MOST
from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities.base import Quantity
from pyrofit.results import recorded
from pyrofit.results.comparison import read_bands_of_sets
from pyrofit.results.files import Results, read_csv
from pyrofit.show.table import Table
from pyrofit.show.units import unit_cells
from pyrofit.solver.arrays import FloatArray


def width_of_bands(study: Study, results: Results) -> pd.DataFrame:
    """Say how wide the predictions of the good sets are, and which share of the data lies within.

    Returns
    -------
    pandas.DataFrame
        One row per experiment, signal and cost function, and one for all of these together. Width:
        mean over time, of rates in per cent of their measured mean. Within: per cent of the
        measured points inside the band, and inside the band widened by their stated uncertainty.
    """
    frame = read_bands_of_sets(study, results)
    met = read_csv(results.comparison("family.csv"), {"met": float}).groupby("cost_function")["met"]
    tried = met.first().astype(int).to_dict()
    pairs = frame[["experiment", "signal"]].drop_duplicates().itertuples(index=False)
    among = [study.experiments[name].quantity(signal) for name, signal in pairs]
    rows = []
    for (name, signal, cost), part in frame.groupby(
        ["experiment", "signal", "cost_function"], sort=False
    ):
        about = {
            "experiment": title_of(study, str(name)),
            "signal": study.experiments[str(name)].words(str(signal)),
            "cost_function": cost,
            "good_sets": tried.get(str(cost), sum(tried.values())),
            "simulated": int(part["sets"].iloc[0]),
        }
        measured = recorded.series(study, results, str(name), str(signal))
        quantity = study.experiments[str(name)].quantity(str(signal))
        rows.append({**about, **_width(part, measured, quantity, among)})
    return pd.DataFrame(rows)


def _width(
    part: pd.DataFrame, measured: pd.DataFrame, quantity: Quantity, among: Sequence[Quantity]
) -> dict[str, float | None]:
    """Return the mean width of a band, and the shares of the measured points inside."""
    margin = measured.get(quantity.uncertainty_column)
    width = float((part["high"] - part["low"]).mean())
    relative = 100.0 * width / abs(part["measured"].mean()) if quantity.relative else None
    wider = None if margin is None else _within(part, margin.to_numpy(float))
    return {
        "width_percent": relative,
        **unit_cells("width", quantity, width, among),
        "within_percent": _within(part, 0.0),
        "within_with_uncertainty_percent": wider,
    }


def _within(part: pd.DataFrame, margin: FloatArray | float) -> float:
    inside = (part["measured"] >= part["low"] - margin) & (
        part["measured"] <= part["high"] + margin
    )
    return 100.0 * float(inside.mean())


TABLE = Table(
    place=60,
    make=width_of_bands,
    title="Predictions of the good sets",
    note=f"Good sets: their cost is at most {GOOD:g} of the lowest known one. A random walk "
    f"that starts from the best set samples them. At most {MOST} are simulated for each "
    "cost function, those that lie farthest apart. Width: highest minus lowest "
    "prediction, mean over time. Within: share of the measured points inside the "
    "band, and inside the band widened by their stated uncertainty. The band is the "
    "range of the good sets, not a confidence interval.",
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
