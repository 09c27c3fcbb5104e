"""Predicted and measured curves over time."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pyrofit.analysis.uses import (
    CMAES,
    LEAST_SQUARES,
    PUBLISHED,
    SCEUA,
    PredictedSet,
    fitted_experiments,
    predicted,
    predicted_sets,
    title_of,
)
from pyrofit.config import Study
from pyrofit.quantities import known_quantities
from pyrofit.results import prediction, recorded
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.names import data_name

Convert = Callable[[Any], Any]


Look = dict[str, Any]


MLR_LABEL = "mass loss rate [g/(m² s)]"


def fitted_rates(study: Study) -> list[str]:
    """Return the fitted experiments whose mass loss rate is predicted."""
    return [n for n in predicted(study, "mlr") if n in fitted_experiments(study)]


def held_out_rates(study: Study) -> list[str]:
    """Return the held-out experiments whose mass loss rate is predicted."""
    return [n for n in predicted(study, "mlr") if n not in fitted_experiments(study)]


def compare_curves(
    study: Study,
    results: Results,
    names: Sequence[str],
    origins: tuple[str, ...],
    signal: str = "mlr",
) -> Canvas:
    """Draw measured and predicted curves, one panel per experiment."""
    convert = grams if signal == "mlr" else style.celsius
    curves = predicted_curves(study, results)
    shown = [s for s in predicted_sets(study) if s.origin in origins]
    canvas, axes = panels_of(study, names)
    for ax, name in zip(axes, names, strict=True):
        frame = recorded.series(study, results, name, signal)
        draw_band(ax, frame, signal, convert)
        ax.plot(frame["time_s"], convert(frame[known_quantities()[signal].column]), **_MEASURED)
        # Published ones last are hidden by nothing; ours come on top of them.
        for chosen in sorted(shown, key=lambda s: s.origin != PUBLISHED):
            curve = curve_of(curves, name, signal, chosen.label)
            ax.plot(curve["time_s"], convert(curve["simulated"]), **look_of(study, chosen))
    label_axes(axes, MLR_LABEL if signal == "mlr" else "back temperature [°C]")
    entries = measured_entries(study, results, names, signal, with_line=True)
    style.legend_below(canvas, [*entries, *set_entries(study, shown)])
    return canvas


_MEASURED: Look = {"color": style.MEASURED, "linewidth": 0.7}


_THEIRS: Look = {"color": style.PUBLISHED, "linewidth": 0.6, "markersize": 3.2}
_THEIRS |= {"markerfacecolor": "white", "markeredgewidth": 0.7}


_MARKERS = "osD^vp"


_MARK_EVERY = 0.09
"""Distance of markers, in diagonals of the panel."""


def panels_of(study: Study, names: Sequence[str]) -> tuple[Canvas, list[Axes]]:
    """Return a canvas with a panel for each experiment."""
    one = len(names) == 1
    width, height = (140.0, 82.0) if one else (style.TWO_COLUMNS, 72.0)
    canvas, axes = style.panels(len(names), 2, width, height)
    style.letter(axes, [title_of(study, name) for name in names])
    return canvas, axes


def label_axes(axes: Sequence[Axes], text: str) -> None:
    """Label the axes of panels whose abscissa is time."""
    for ax in axes:
        ax.set_xlabel("time [s]")
        ax.set_xlim(left=0.0)
        if ax.get_subplotspec().is_first_col():  # type: ignore[union-attr]
            ax.set_ylabel(text)


def grams(kilograms: Any) -> Any:
    """Convert kg to g, for an axis."""
    return np.asarray(kilograms, dtype=float) * 1e3


def predicted_curves(study: Study, results: Results) -> pd.DataFrame:
    """Return the curves of all predicted sets."""
    labels = [chosen.label for chosen in predicted_sets(study)]
    return prediction.curves(study, results, labels)


def curve_of(curves: pd.DataFrame, name: str, signal: str, label: str) -> pd.DataFrame:
    """Return the curve of one signal and set."""
    here = (curves["experiment"] == name) & (curves["signal"] == signal)
    return curves[here & (curves["set"] == label)]


def draw_band(
    ax: Axes, frame: pd.DataFrame, signal: str, convert: Convert, about_zero: bool = False
) -> None:
    """Shade measured value ± uncertainty, where one is known."""
    if known_quantities()[signal].uncertainty_column not in frame:
        return
    width = frame[known_quantities()[signal].uncertainty_column].to_numpy(float)
    value = (
        np.zeros_like(width)
        if about_zero
        else frame[known_quantities()[signal].column].to_numpy(float)
    )
    low, high = convert(value - width), convert(value + width)
    ax.fill_between(frame["time_s"], low, high, color=style.BAND, linewidth=0.0)


def look_of(study: Study, chosen: PredictedSet) -> Look:
    """Return the line style of a set."""
    look = dict(style.cost_styles(study)[chosen.cost])
    if chosen.origin == PUBLISHED:
        return {**_THEIRS, **_marks(study, chosen.cost)}
    if chosen.origin in (LEAST_SQUARES, CMAES):
        first, marker = (0.0, "o") if chosen.origin == LEAST_SQUARES else (0.03, "s")
        marks = {"marker": marker, "markersize": 2.2, "markevery": (first, 0.06)}
        return {**look, "linewidth": 0.7, **marks}
    return look


def _marks(study: Study, cost: str) -> Look:
    """Return the markers of a cost's published set, beside those of the other costs."""
    costs = list(study.imp.costs)
    i = costs.index(cost)
    first = _MARK_EVERY * (i + 1) / (len(costs) + 1)
    return {"marker": _MARKERS[i % len(_MARKERS)], "markevery": (first, _MARK_EVERY)}


def measured_entries(
    study: Study, results: Results, names: Sequence[str], signal: str, with_line: bool
) -> list[Line2D | Patch]:
    """Return the legend entries of the measurement, its band only where an uncertainty is known."""
    known = any(
        known_quantities()[signal].uncertainty_column in recorded.series(study, results, n, signal)
        for n in names
    )
    name = data_name(study, [(n, signal) for n in names])
    entries: list[Line2D | Patch] = [style.line(name, **_MEASURED)] if with_line else []
    return entries + ([style.patch("uncertainty", color=style.BAND)] if known else [])


def set_entries(study: Study, shown: Sequence[PredictedSet]) -> list[Line2D | Patch]:
    """Return the legend entries of the sets, those of one cost together."""
    several = {s.origin for s in shown} != {SCEUA}
    order = [s.cost for s in shown]
    together = sorted(shown, key=lambda s: order.index(s.cost))
    return [
        style.line(f"{s.cost} {s.origin}" if several else s.cost, **look_of(study, s))
        for s in together
    ]
