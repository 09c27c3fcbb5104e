"""Predictions of the good sets, drawn."""

from collections.abc import Mapping
from typing import Any

import pandas as pd

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities.base import Quantity
from pyrofit.results import recorded
from pyrofit.results.comparison import ALL
from pyrofit.results.comparison import read_bands_of_sets as band_curves
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import draw_band, label_of_axis
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.names import data_name
from pyrofit.show.units import shown

_BAND: DrawStyle = {"color": "#9ecae1", "linewidth": 0.0}


def good_sets(study: Study, results: Results) -> Canvas:
    """Draw the predictions of the good sets over time, beside the data."""
    frame = band_curves(study, results)
    pairs = list(frame[["experiment", "signal"]].drop_duplicates().itertuples(index=False))
    canvas, axes = style.panels(len(pairs), 2, style.TWO_COLUMNS, 62.0)
    style.letter(axes, [title_of(study, name) for name, _ in pairs])
    looks = style.cost_styles(study)
    stated = False
    for ax, (name, signal) in zip(axes, pairs, strict=True):
        here = frame[(frame["experiment"] == name) & (frame["signal"] == signal)]
        quantity = study.experiments[name].quantity(signal)
        measured = recorded.series(study, results, name, signal)
        stated = stated or quantity.uncertainty_column in measured
        draw_band(ax, measured, quantity)
        _draw(ax, here, quantity, looks)
        ax.plot(
            measured["time_s"],
            shown(quantity, measured[quantity.column]),
            color=style.MEASURED,
            linewidth=0.7,
        )
        ax.set_xlim(left=0.0)
        ax.set_xlabel("time [s]")
        style.label_y(ax, label_of_axis(study, name, signal))
    data = data_name(study, [(name, signal) for name, signal in pairs])
    entries: list[Any] = [style.line(data, color=style.MEASURED, linewidth=0.7)]
    entries += [style.patch("stated uncertainty", color=style.BAND)] if stated else []
    entries.append(style.patch("sets near the lowest cost", color=_BAND["color"]))
    entries += [style.line(f"{c}, lowest cost known", **look) for c, look in looks.items()]
    style.legend_below(canvas, entries)
    return canvas


def _draw(ax: Axes, bands: pd.DataFrame, quantity: Quantity, looks: Mapping[str, Any]) -> None:
    """Draw the band around all good sets, and the best set of each cost function."""
    around = bands[bands["cost_function"] == (ALL if len(looks) > 1 else next(iter(looks)))]
    low, high = (shown(quantity, around[end]) for end in ("low", "high"))
    ax.fill_between(around["time_s"], low, high, **_BAND)
    for cost, look in looks.items():
        best = bands[bands["cost_function"] == cost]
        ax.plot(best["time_s"], shown(quantity, best["best"]), **{**look, "linewidth": 0.9})


FIGURE = Figure(
    place=60,
    applies=lambda study: bool(study.validation.experiments),
    make=good_sets,
    title="Predictions of the good sets",
    caption="Lowest and highest prediction of all sets whose cost is near the lowest known "
    "one (blue). The lines are the sets of the lowest cost of each cost function. The blue "
    "area does not include the noise of the measurement. If data lie outside it by more than "
    "their uncertainty, no choice of a set helps: the model or its given values are wrong.",
)
