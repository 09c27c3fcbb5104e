"""Figs 3 and 4, residuals, back temperatures: predicted and measured curves over time."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pyrofit.config import Study
from pyrofit.figures import style
from pyrofit.quantities import known_quantities
from pyrofit.results import prediction, recorded
from pyrofit.results.files import Results
from pyrofit.tables.describe import (
    CMAES,
    LEAST_SQUARES,
    PUBLISHED,
    SCEUA,
    PredictedSet,
    data_name,
    fitted_experiments,
    predicted,
    predicted_sets,
    title_of,
)

Convert = Callable[[Any], Any]
Look = dict[str, Any]
MLR_LABEL = "mass loss rate [g/(m² s)]"


def fitted_rates(study: Study) -> list[str]:
    """Return the fitted experiments whose mass loss rate is predicted."""
    return [n for n in predicted(study, "mlr") if n in fitted_experiments(study)]


def held_out_rates(study: Study) -> list[str]:
    """Return the held-out experiments whose mass loss rate is predicted."""
    return [n for n in predicted(study, "mlr") if n not in fitted_experiments(study)]


def fig3(study: Study, results: Results) -> Canvas:
    """Fig. 3: mass loss rate at the fitted experiment, target and best set of each cost."""
    return _compare(study, results, fitted_rates(study), (SCEUA, PUBLISHED))


def fig4(study: Study, results: Results) -> Canvas:
    """Fig. 4: mass loss rate at the held-out experiment, measured and predicted."""
    return _compare(study, results, held_out_rates(study), (SCEUA, PUBLISHED))


def optimisers(study: Study, results: Results) -> Canvas:
    """Draw the best sets of all optimisers at all predicted experiments."""
    names = predicted(study, "mlr")
    return _compare(study, results, names, (SCEUA, LEAST_SQUARES, CMAES))


def back_temperature(study: Study, results: Results) -> Canvas:
    """Draw the back temperature over time at all predicted experiments."""
    names = predicted(study, "back_temperature")
    return _compare(study, results, names, (SCEUA, PUBLISHED), "back_temperature")


def residuals(study: Study, results: Results) -> Canvas:
    """Draw simulated minus measured mass loss rate over time, with the uncertainty about zero."""
    names = predicted(study, "mlr")
    canvas, axes = _panels(study, names)
    curves = _predicted_curves(study, results)
    shown = [s for s in predicted_sets(study) if s.origin == SCEUA]
    for ax, name in zip(axes, names, strict=True):
        _band(ax, recorded.series(study, results, name, "mlr"), "mlr", _grams, about_zero=True)
        style.zero_line(ax)
        for chosen in shown:
            curve = _curve(curves, name, "mlr", chosen.label)
            difference = curve["simulated"] - curve["measured"]
            look = _look(study, chosen)
            points = {"color": look["color"], "linewidth": 0.4, "alpha": 0.4}
            ax.plot(curve["time_s"], _grams(difference), **points)
            ax.plot(curve["time_s"], _grams(running_mean(difference)), **look)
    data = data_name(study, [(name, "mlr") for name in names])
    _label(axes, f"simulated − {data}\n{MLR_LABEL}")
    entries = _measured_entries(study, results, names, "mlr", with_line=False)
    style.legend_below(canvas, [*entries, *_set_entries(study, shown)])
    return canvas


def running_mean(series: pd.Series) -> pd.Series:
    """Return the mean over windows of 3 % of the points, an odd number, shorter at the ends."""
    window = 2 * (int(0.03 * len(series)) // 2) + 1
    return series.rolling(window, center=True, min_periods=1).mean()


def _compare(
    study: Study,
    results: Results,
    names: Sequence[str],
    origins: tuple[str, ...],
    signal: str = "mlr",
) -> Canvas:
    """Draw measured and predicted curves, one panel per experiment."""
    convert = _grams if signal == "mlr" else style.celsius
    curves = _predicted_curves(study, results)
    shown = [s for s in predicted_sets(study) if s.origin in origins]
    canvas, axes = _panels(study, names)
    for ax, name in zip(axes, names, strict=True):
        frame = recorded.series(study, results, name, signal)
        _band(ax, frame, signal, convert)
        ax.plot(frame["time_s"], convert(frame[known_quantities()[signal].column]), **_MEASURED)
        # Published ones last are hidden by nothing; ours come on top of them.
        for chosen in sorted(shown, key=lambda s: s.origin != PUBLISHED):
            curve = _curve(curves, name, signal, chosen.label)
            ax.plot(curve["time_s"], convert(curve["simulated"]), **_look(study, chosen))
    _label(axes, MLR_LABEL if signal == "mlr" else "back temperature [°C]")
    entries = _measured_entries(study, results, names, signal, with_line=True)
    style.legend_below(canvas, [*entries, *_set_entries(study, shown)])
    return canvas


_MEASURED: Look = {"color": style.MEASURED, "linewidth": 0.7}
_THEIRS: Look = {"color": style.PUBLISHED, "linewidth": 0.6, "markersize": 3.2}
_THEIRS |= {"markerfacecolor": "white", "markeredgewidth": 0.7}
_MARKERS = "osD^vp"
_MARK_EVERY = 0.09
"""Distance of markers, in diagonals of the panel."""


def _panels(study: Study, names: Sequence[str]) -> tuple[Canvas, list[Axes]]:
    one = len(names) == 1
    width, height = (140.0, 82.0) if one else (style.TWO_COLUMNS, 72.0)
    canvas, axes = style.panels(len(names), 2, width, height)
    style.letter(axes, [title_of(study, name) for name in names])
    return canvas, axes


def _label(axes: Sequence[Axes], text: str) -> None:
    for ax in axes:
        ax.set_xlabel("time [s]")
        ax.set_xlim(left=0.0)
        if ax.get_subplotspec().is_first_col():  # type: ignore[union-attr]
            ax.set_ylabel(text)


def _grams(kilograms: Any) -> Any:
    return np.asarray(kilograms, dtype=float) * 1e3


def _predicted_curves(study: Study, results: Results) -> pd.DataFrame:
    labels = [chosen.label for chosen in predicted_sets(study)]
    return prediction.curves(study, results, labels)


def _curve(curves: pd.DataFrame, name: str, signal: str, label: str) -> pd.DataFrame:
    here = (curves["experiment"] == name) & (curves["signal"] == signal)
    return curves[here & (curves["set"] == label)]


def _band(
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


def _look(study: Study, chosen: PredictedSet) -> Look:
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


def _measured_entries(
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


def _set_entries(study: Study, shown: Sequence[PredictedSet]) -> list[Line2D | Patch]:
    """Return the legend entries of the sets, those of one cost together."""
    several = {s.origin for s in shown} != {SCEUA}
    order = [s.cost for s in shown]
    together = sorted(shown, key=lambda s: order.index(s.cost))
    return [
        style.line(f"{s.cost} {s.origin}" if several else s.cost, **_look(study, s))
        for s in together
    ]
