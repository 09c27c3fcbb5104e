"""Windows in which data lie outside, and their likely causes."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Table
from pyrofit.steps.preview import record
from pyrofit.steps.preview.sentences import size_words, window_span


def outside(study: Study, results: Results) -> pd.DataFrame:
    """List the windows in which records lie outside."""
    rows = []
    for window in record.read(results).windows:
        quantity = study.experiments[window.experiment].quantity(window.signal)
        rows.append(
            {
                "experiment": window.experiment,
                "signal": window.signal,
                "side": "above" if window.above else "below",
                "window": window_span(quantity, window.begins, window.ends),
                "largest": size_words(quantity, window.largest),
                "share_percent": 100.0 * window.share,
            }
        )
    columns = ["experiment", "signal", "side", "window", "largest", "share_percent"]
    return pd.DataFrame(rows, columns=columns)


def causes_table(study: Study, results: Results) -> pd.DataFrame:
    """List the likely causes, the likeliest first."""
    rows = [
        {
            "cause": one.cause,
            "words": one.words,
            "explained_percent": 100.0 * one.explained,
            "left_percent": 100.0 * one.left,
        }
        for one in record.read(results).causes
    ]
    return pd.DataFrame(rows, columns=["cause", "words", "explained_percent", "left_percent"])


TABLES = {
    "outside": Table(
        place=60,
        make=outside,
        title="Data outside all that the limits allow",
        note="Largest: distance from the band of all sets. Share: the same over the range.",
        headings={"largest": "largest distance", "share_percent": "share [%]"},
    ),
    "causes": Table(
        place=70,
        make=causes_table,
        title="Likely causes",
        note="Explained: part of the squared difference between data and nearest set that the "
        "correction takes away. Left: root mean square of the rest over the range.",
        headings={"explained_percent": "explained [%]", "left_percent": "left [%]"},
    ),
}
