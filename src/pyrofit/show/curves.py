"""Predicted and measured curves over time."""

from collections.abc import Sequence
from itertools import takewhile

import pandas as pd

from pyrofit.analysis.uses import (
    ESTIMATES,
    PUBLISHED,
    SCEUA,
    STARTED,
    PredictedSet,
    predicted_sets,
    title_of,
)
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.quantities.base import Quantity
from pyrofit.results import prediction, recorded
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle, Line2D, Patch
from pyrofit.show.names import data_name
from pyrofit.show.units import difference, shown

Pair = tuple[str, str]
"""Names of an experiment and a signal."""


def compare_curves(
    study: Study, results: Results, pairs: Sequence[Pair], sets: Sequence[PredictedSet] = ()
) -> Canvas:
    """Draw data and sets, one panel per signal; repeats of a test share one.

    Without ``sets`` these are the estimates, and what stands beside them in the paper.
    """
    curves = predicted_curves(study, results)
    shown_sets = sets or sets_beside_data(study)
    groups = tests_of(study, pairs)
    canvas, axes = panels_of(study, [group[0] for group in groups])
    style.letter(axes, [title_of_test(study, group) for group in groups])
    for ax, group in zip(axes, groups, strict=True):
        for name, signal in group:
            _draw_measured(ax, study, results, name, signal)
        # Published ones last are hidden by nothing; ours come on top of them.
        for chosen in sorted(shown_sets, key=lambda s: s.origin != PUBLISHED):
            look = look_of(study, chosen) | ({"linewidth": 0.7} if len(group) > 1 else {})
            for name, signal in group:
                quantity = study.experiments[name].quantity(signal)
                curve = curve_of_set(curves, name, signal, chosen.label)
                ax.plot(curve["time_s"], shown(quantity, curve["simulated"]), **look)
    label_axes(axes, [label_of_axis(study, *group[0]) for group in groups])
    entries = measured_entries(study, results, pairs, with_line=True)
    style.legend_below(canvas, [*entries, *set_entries(study, shown_sets)])
    return canvas


def sets_beside_data(study: Study) -> list[PredictedSet]:
    """Return the sets that stand beside the data: estimates; with published sets also SCE-UA's."""
    origins = (ESTIMATES, SCEUA, PUBLISHED) if study.published else (ESTIMATES,)
    return [s for s in predicted_sets(study) if s.origin in origins]


def tests_of(study: Study, pairs: Sequence[Pair]) -> list[list[Pair]]:
    """Return the pairs of each test together: those of its repeats that have the signal."""
    groups: dict[Pair, list[Pair]] = {}
    for name, signal in pairs:
        repeat = study.experiments[name].repeat
        groups.setdefault((repeat.test if repeat else name, signal), []).append((name, signal))
    return list(groups.values())


def title_of_test(study: Study, group: Sequence[Pair]) -> str:
    """Return the title of a test: the common beginning of the titles of its repeats."""
    titles = [title_of(study, name) for name, _ in group]
    if len(titles) == 1:
        return titles[0]
    same = takewhile(lambda of: len({*of}) == 1, zip(*titles, strict=False))
    return "".join(of[0] for of in same).rstrip(" ,;(") or titles[0]


def _draw_measured(ax: Axes, study: Study, results: Results, name: str, signal: str) -> None:
    """Draw a measured series with its uncertainty."""
    quantity = study.experiments[name].quantity(signal)
    frame = recorded.series(study, results, name, signal)
    draw_band(ax, frame, quantity)
    ax.plot(frame["time_s"], shown(quantity, frame[quantity.column]), **_MEASURED)


def label_of_axis(study: Study, name: str, signal: str) -> str:
    """Return the label of an axis, in short lines: the signal in words and the unit shown."""
    experiment = study.experiments[name]
    unit = experiment.quantity(signal).shown.unit
    return style.in_lines(f"{experiment.words(signal)} [{unit}]")


_MEASURED: DrawStyle = {"color": style.MEASURED, "linewidth": 0.7}


_ESTIMATES: DrawStyle = {"color": style.ESTIMATES, "linewidth": 1.3}


_THEIRS: DrawStyle = {"color": style.PUBLISHED, "linewidth": 0.6, "markersize": 3.2}
_THEIRS |= {"markerfacecolor": "white", "markeredgewidth": 0.7}


_MARKERS = "osD^vp"


_MARK_EVERY = 0.09
"""Distance of markers, in diagonals of the panel."""


def panels_of(study: Study, pairs: Sequence[Pair]) -> tuple[Canvas, list[Axes]]:
    """Return a canvas with a panel for each signal."""
    one = len(pairs) == 1
    width, height = (140.0, 82.0) if one else (style.TWO_COLUMNS, 72.0)
    canvas, axes = style.panels(len(pairs), 2, width, height)
    style.letter(axes, [title_of(study, name) for name, _ in pairs])
    return canvas, axes


def label_axes(axes: Sequence[Axes], texts: Sequence[str]) -> None:
    """Label panels whose abscissa is time, each ordinate once where neighbours share it."""
    for i, (ax, text) in enumerate(zip(axes, texts, strict=True)):
        ax.set_xlabel("time [s]")
        ax.set_xlim(left=0.0)
        first = ax.get_subplotspec().is_first_col()  # type: ignore[union-attr]
        if first or text != texts[i - 1]:
            ax.set_ylabel(text)


def predicted_curves(study: Study, results: Results) -> pd.DataFrame:
    """Return the curves of all predicted sets."""
    labels = [chosen.label for chosen in predicted_sets(study)]
    return prediction.read_predicted_curves(study, results, labels)


def curve_of_set(curves: pd.DataFrame, name: str, signal: str, label: str) -> pd.DataFrame:
    """Return the curve of one signal and set."""
    here = (curves["experiment"] == name) & (curves["signal"] == signal)
    return curves[here & (curves["set"] == label)]


def draw_band(ax: Axes, frame: pd.DataFrame, quantity: Quantity, about_zero: bool = False) -> None:
    """Shade measured value ± uncertainty, where one is known."""
    if quantity.uncertainty_column not in frame:
        return
    width = frame[quantity.uncertainty_column].to_numpy(float)
    value = frame[quantity.column].to_numpy(float)
    low, high = (
        difference(quantity, side * width) if about_zero else shown(quantity, value + side * width)
        for side in (-1.0, 1.0)
    )
    ax.fill_between(frame["time_s"], low, high, color=style.BAND, linewidth=0.0)


def look_of(study: Study, chosen: PredictedSet) -> DrawStyle:
    """Return the line style of a set."""
    if chosen.origin == ESTIMATES:
        return _ESTIMATES
    look = style.cost_styles(study)[chosen.cost]
    if chosen.origin == PUBLISHED:
        return {**_THEIRS, **_marks(study, chosen.cost)}
    if chosen.origin in STARTED:
        (marker,) = (by.marker for by in OPTIMISERS.values() if by.words == chosen.origin)
        first = 0.03 * STARTED.index(chosen.origin)
        marks: DrawStyle = {"marker": marker, "markersize": 2.2, "markevery": (first, 0.06)}
        return {**look, "linewidth": 0.7, **marks}
    return look


def _marks(study: Study, cost: str) -> DrawStyle:
    """Return the markers of a cost's published set, beside those of the other costs."""
    costs = list(study.imp.costs)
    i = costs.index(cost)
    first = _MARK_EVERY * (i + 1) / (len(costs) + 1)
    return {"marker": _MARKERS[i % len(_MARKERS)], "markevery": (first, _MARK_EVERY)}


def measured_entries(
    study: Study, results: Results, pairs: Sequence[Pair], with_line: bool
) -> list[Line2D | Patch]:
    """Return the legend entries of the measurement, its band only where an uncertainty is known."""
    known = any(
        study.experiments[name].quantity(signal).uncertainty_column
        in recorded.series(study, results, name, signal)
        for name, signal in pairs
    )
    entries: list[Line2D | Patch] = []
    entries += [style.line(data_name(study, pairs), **_MEASURED)] if with_line else []
    return entries + ([style.patch("stated uncertainty", color=style.BAND)] if known else [])


def set_entries(study: Study, shown: Sequence[PredictedSet]) -> list[Line2D | Patch]:
    """Return the legend entries of the sets, those of one cost together."""
    order = [s.cost for s in shown]
    together = sorted(shown, key=lambda s: order.index(s.cost))
    return [style.line(_name(s), **look_of(study, s)) for s in together]


def _name(chosen: PredictedSet) -> str:
    return ESTIMATES if chosen.origin == ESTIMATES else f"{chosen.cost} {chosen.origin}"
