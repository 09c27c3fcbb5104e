"""Where the sets of all repetitions lie."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.best_sets import ends
from pyrofit.analysis.uses import SCEUA, STARTED
from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results import searches
from pyrofit.results.files import Results
from pyrofit.results.identification import estimates
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.text import typeset

_WIDTH = 0.5
"""Width over which the repetitions of a cost function are laid out, in columns."""


_POINTS: DrawStyle = {"linestyle": "none", "marker": ".", "markersize": 4.0, "alpha": 0.7}


_BEST: dict[str, DrawStyle] = {
    by.words: {
        "linestyle": "none",
        "marker": by.marker,
        "markersize": 4.0,
        "markerfacecolor": "white",
    }
    for by in OPTIMISERS.values()
}


_BESIDE = {by: 0.33 + 0.09 * i for i, by in enumerate(STARTED)}
"""Places of the best sets beside the repetitions, in columns."""


_TRUTH: DrawStyle = {"color": "black", "linewidth": 0.9, "linestyle": (0, (5, 2))}


_PUBLISHED: DrawStyle = {"color": "black", "marker": "_", "markersize": 6.0, "linewidth": 0.8}


def draw_spread(study: Study, results: Results) -> Canvas:
    """Draw all repetitions' sets by cost function within the limits, a panel per parameter."""
    names = list(study.imp.estimate)
    found = ends(study, searches.read(study, results, OPTIMISERS))
    intervals = estimates(study, results)
    canvas, axes = style.panels(len(names), 3, style.TWO_COLUMNS, 46.0)
    style.letter(axes, [typeset(f"{name} [{study.parameters[name].unit}]") for name in names])
    for ax, name in zip(axes, names, strict=True):
        _draw_spread(ax, study, found, intervals, name)
    style.legend_below(canvas, _spread_entries(study))
    return canvas


def _draw_spread(
    ax: Axes, study: Study, found: pd.DataFrame, intervals: pd.DataFrame, name: str
) -> None:
    parameter = study.parameters[name]
    lower, upper = (bound / parameter.factor for bound in parameter.bounds_si)
    low, high = intervals.loc[[name], ["low", "high"]].to_numpy(float)[0] / parameter.factor
    ax.axhspan(low, high, color=style.BAND, linewidth=0.0, zorder=0.5)
    for i, (cost, look) in enumerate(style.cost_styles(study).items()):
        here = found[found["cost_function"] == cost]
        ours = here[here["found_by"] == SCEUA][name].to_numpy(float) / parameter.factor
        across = i + _WIDTH * (np.arange(ours.size) + 0.5) / ours.size - 0.5 * _WIDTH
        ax.plot(across, ours, color=look["color"], clip_on=False, **_POINTS)
        for by, marks in _BEST.items():
            best = here[(here["found_by"] == by) & here["best"]][name] / parameter.factor
            at = np.full(len(best), i + _BESIDE[by])
            ax.plot(at, best, color=look["color"], clip_on=False, **marks)
        theirs = study.published.costs.get(cost, {}).get(name) if study.published else None
        if theirs is not None:
            ax.errorbar(i - 0.36, theirs[1], yerr=theirs[2], **_PUBLISHED)
    if study.synthetic is not None:
        ax.axhline(study.synthetic.truth[name], **_TRUTH)
    margin = 0.03 * (upper - lower)
    ax.set_ylim(lower - margin, upper + margin)
    for limit in (lower, upper):
        ax.axhline(limit, color="0.4", linewidth=0.5)
    ax.set_xlim(-0.5, len(study.imp.costs) - 0.5)
    ax.set_xticks(range(len(study.imp.costs)), list(study.imp.costs))
    ax.tick_params(axis="x", length=0)


def _spread_entries(study: Study) -> list[Any]:
    entries = [
        style.line("SCE-UA, every repetition", color="0.3", **_POINTS),
        *(style.line(f"{by}, best", color="0.3", **marks) for by, marks in _BEST.items()),
        style.patch("95 % interval of the data", color=style.BAND),
        style.line("limits", color="0.4", linewidth=0.5),
    ]
    if study.published is not None:
        entries.append(style.line("published mean ± sigma", **_PUBLISHED))
    if study.synthetic is not None:
        entries.append(style.line("truth", **_TRUTH))
    return entries


FIGURE = Figure(
    place=50,
    make=draw_spread,
    title="Where the sets of all repetitions lie",
    caption="Each dot is the best set of one repetition of SCE-UA, in their order from left "
    "to right. Beside them are the best sets of the other optimisers, to the left "
    "those of the literature, if any. The axis ends at the limits. Dots over the "
    "whole height: the repetitions find different values. Dots at one height outside "
    "the grey area (95 % interval): the data do not support the value on which the searches "
    "agree.",
)
