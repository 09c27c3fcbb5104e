"""How far the good sets reach, in a sentence."""

import pandas as pd

from pyrofit.results.comparison import ALL
from pyrofit.show.table import Frames


def reach_of_good_sets(tables: Frames) -> str:
    """Say how far the good sets reach, and which share of the data lies within."""
    table = tables["bands"]
    names = table["cost_function"]
    table = table[names == (ALL if ALL in set(names) else names.iloc[0])]
    parts = [
        f"{row['signal']} at {row['experiment']} {_width(row)} ({row['within_percent']:.0f} % "
        "of the measured points lie inside)"
        for _, row in table.iterrows()
    ]
    return f"Mean width of the predictions of the good sets: {'; '.join(parts)}."


def _width(row: pd.Series) -> str:
    if pd.notna(row["width_percent"]):
        return f"{row['width_percent']:.2g} % of the mean"
    (column,) = (
        str(name)
        for name in row.index
        if str(name).startswith("width") and name != "width_percent" and pd.notna(row[name])
    )
    unit = "K" if column == "width_K" else column.partition("[")[2].rstrip("]")
    return f"{row[column]:.2g} {unit}"
