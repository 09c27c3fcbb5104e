"""Cost functions and optimisers compared: where all sets lie, and what good sets predict."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from pyrofit.config import Study
from pyrofit.figures import style
from pyrofit.figures.determined import draw_matrix
from pyrofit.quantities import known_quantities
from pyrofit.results import recorded, searches
from pyrofit.results.files import Results
from pyrofit.stages.compare import ends
from pyrofit.tables.comparison import ALL, band_curves
from pyrofit.tables.describe import (
    CMAES,
    LEAST_SQUARES,
    SCEUA,
    data_name,
    title_of,
)
from pyrofit.tables.determined import estimates

_WIDTH = 0.5
"""Width over which the repetitions of a cost function are laid out, in columns."""
_POINTS: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 4.0, "alpha": 0.7}
_BEST: dict[str, dict[str, Any]] = {
    by: {"linestyle": "none", "marker": marker, "markersize": 4.0, "markerfacecolor": "white"}
    for by, marker in ((LEAST_SQUARES, "D"), (CMAES, "s"))
}
_BESIDE = {LEAST_SQUARES: 0.33, CMAES: 0.42}
"""Places of the best sets beside the repetitions, in columns."""
_TRUTH: dict[str, Any] = {"color": "black", "linewidth": 0.9, "linestyle": (0, (5, 2))}
_PUBLISHED: dict[str, Any] = {"color": "black", "marker": "_", "markersize": 6.0, "linewidth": 0.8}
_BAND: dict[str, Any] = {"color": "#9ecae1", "linewidth": 0.0}
_AXES = {
    "mlr": ("mass loss rate [g/(m² s)]", 1e3, 0.0),
    "back_temperature": ("back temperature [°C]", 1.0, -273.15),
}


def spread(study: Study, results: Results) -> Canvas:
    """Draw all repetitions' sets by cost function within the limits, a panel per parameter."""
    names = list(study.imp.estimate)
    found = ends(study, results)
    intervals = estimates(study, results)
    canvas, axes = style.panels(len(names), 3, style.TWO_COLUMNS, 46.0)
    style.letter(axes, [f"{name} [{study.parameters[name].unit}]" for name in names])
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


def correlation_of_sets(study: Study, results: Results) -> Canvas:
    """Draw how the parameters go together over the repetitions of every cost function."""
    return draw_matrix(rank_correlation(study, results), "rank correlation [–]")


def rank_correlation(study: Study, results: Results) -> pd.DataFrame:
    """Return Spearman's correlation of the parameters, ranked within each cost function.

    What the cost functions differ in is no correlation. A parameter that always ends at the same
    value has none, and stands with 0.
    """
    names = list(study.imp.estimate)
    summary = searches.summary(study, results)
    ranks = summary.groupby("cost_function")[names].rank()
    ranks = ranks - ranks.groupby(summary["cost_function"]).transform("mean")
    matrix = ranks.corr().fillna(0.0).to_numpy(copy=True)
    np.fill_diagonal(matrix, 1.0)
    return pd.DataFrame(matrix, index=names, columns=names)


def good_sets(study: Study, results: Results) -> Canvas:
    """Draw what the good sets predict, over time, beside the data."""
    frame = band_curves(study, results)
    channels = list(frame[["experiment", "signal"]].drop_duplicates().itertuples(index=False))
    canvas, axes = style.panels(len(channels), 2, style.TWO_COLUMNS, 62.0)
    style.letter(axes, [title_of(study, name) for name, _ in channels])
    looks = style.cost_styles(study)
    stated = False
    for ax, (name, signal) in zip(axes, channels, strict=True):
        label, factor, shift = _AXES[signal]
        measured = recorded.series(study, results, name, signal)
        time, value = measured["time_s"], measured[known_quantities()[signal].column]
        if known_quantities()[signal].uncertainty_column in measured:
            stated = True
            sd = measured[known_quantities()[signal].uncertainty_column]
            low, high = (factor * (value + side * sd) + shift for side in (-1.0, 1.0))
            ax.fill_between(time, low, high, color=style.BAND, linewidth=0.0)
        here = frame[(frame["experiment"] == name) & (frame["signal"] == signal)]
        around = here[here["cost_function"] == (ALL if len(looks) > 1 else next(iter(looks)))]
        low, high = (factor * around[end] + shift for end in ("low", "high"))
        ax.fill_between(around["time_s"], low, high, **_BAND)
        ax.plot(time, factor * value + shift, color=style.MEASURED, linewidth=0.7)
        for cost, look in looks.items():
            best = here[here["cost_function"] == cost]
            ax.plot(best["time_s"], factor * best["best"] + shift, **{**look, "linewidth": 0.9})
        ax.set_xlim(left=0.0)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(label)
    data = data_name(study, [(name, signal) for name, signal in channels])
    entries: list[Any] = [style.line(data, color=style.MEASURED, linewidth=0.7)]
    entries += [style.patch("uncertainty", color=style.BAND)] if stated else []
    entries.append(style.patch("reach of the good sets", color=_BAND["color"]))
    entries += [style.line(f"{c}, lowest cost known", **look) for c, look in looks.items()]
    style.legend_below(canvas, entries)
    return canvas
