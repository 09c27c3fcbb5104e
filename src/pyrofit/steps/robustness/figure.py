"""Errors of the cost functions against noise and outliers."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas
from pyrofit.show.figure import Figure
from pyrofit.steps.robustness.twins import NOISE, OUTLIERS, errors_of_twins

_ASIDE = 0.14
"""Distance of the cost functions' marks at one level, in levels."""


_LABELS = {NOISE: "noise, multiple of the measurement's", OUTLIERS: "outliers [% of points]"}


_MARKERS = "oDs^vp"


def draw_robustness(study: Study, results: Results) -> Canvas:
    """Draw the errors of parameters and predictions against noise and outliers."""
    frame = errors_of_twins(study, results)
    frame["prediction"] = 100.0 * frame["prediction_error"].astype(float)
    held_out = bool(frame["prediction"].notna().any())
    shown = [("error", "error of the recovered\nparameters [% of search range]")]
    shown += [("prediction", "error of the prediction\n[CV(RMSE), %]")] if held_out else []
    canvas, axes = style.panels(2 * len(shown), 2, style.TWO_COLUMNS, 55.0)
    style.letter(axes, ["noise", "outliers"] * len(shown))
    for row, (column, label) in enumerate(shown):
        for side, kind in enumerate((NOISE, OUTLIERS)):
            ax = axes[2 * row + side]
            _draw(ax, study, frame[frame["kind"] == kind], column)
            ax.set_xlabel(_LABELS[kind])
        axes[2 * row].set_ylabel(label)
    looks = style.cost_styles(study)
    entries: list[Any] = [
        style.line(cost, color=look["color"], marker=_MARKERS[i % 6], markersize=4.0)
        for i, (cost, look) in enumerate(looks.items())
    ]
    entries.append(style.line("one twin", color="0.5", linestyle="none", marker="."))
    style.legend_below(canvas, entries)
    canvas.suptitle("Twins of known truth (synthetic data)")
    return canvas


def _draw(ax: Axes, study: Study, frame: pd.DataFrame, column: str) -> None:
    levels = sorted(frame["level"].unique())
    costs = style.cost_styles(study)
    for i, (cost, look) in enumerate(costs.items()):
        here = frame[frame["cost_function"] == cost]
        at = np.arange(len(levels)) + _ASIDE * (i - 0.5 * (len(costs) - 1))
        values = [here.loc[here["level"] == level, column].to_numpy(float) for level in levels]
        for x, twins in zip(at, values, strict=True):
            dots = {"linestyle": "none", "marker": ".", "markersize": 3.0, "alpha": 0.5}
            ax.plot(np.full(twins.size, x), twins, color=look["color"], **dots)  # type: ignore[arg-type]
        medians = [float(np.median(twins)) for twins in values]
        ax.plot(at, medians, color=look["color"], marker=_MARKERS[i % 6], markersize=4.0)
    scale = 1.0 if (frame["kind"] == NOISE).all() else 100.0
    ax.set_xticks(range(len(levels)), [f"{scale * level:g}" for level in levels])
    ax.set_xlim(-0.5, len(levels) - 0.5)
    ax.set_ylim(bottom=0.0)


FIGURE = Figure(
    place=10,
    make=draw_robustness,
    title="Twins of known truth",
    caption="Errors of the fits against how much noise (left) and how many outliers (right) "
    "the twins have; dots: one twin each, lines: their median. A cost function whose "
    "line stays low is robust. Lines within each other's dots do not differ.",
)
