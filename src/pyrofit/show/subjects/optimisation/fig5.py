"""Fig. 5: how the searches converge."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.running import minima_on_one_axis
from pyrofit.config import Study
from pyrofit.results import searches
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure

ACROSS = 3
"""Cost functions side by side."""


_LS: DrawStyle = {"color": "black", "linestyle": (0, (5, 2)), "linewidth": 0.9}


_PUBLISHED: DrawStyle = {"color": "black", "linestyle": (0, (1, 1.5)), "linewidth": 1.1}


def fig5(study: Study, results: Results) -> Canvas:
    """Fig. 5: spread of the repetitions' running minima by generation and by model calls."""
    convergence = searches.running_minima(study, results)
    names = list(study.imp.costs)
    across = min(ACROSS, len(names))
    blocks = -(-len(names) // across)
    width = style.TWO_COLUMNS if across > 1 else style.ONE_COLUMN
    canvas, axes = style.panels(2 * blocks * across, across, width, 55.0)
    for i, cost in enumerate(names):
        first = 2 * across * (i // across) + i % across
        frame = convergence[convergence["cost_function"] == cost]
        for ax, abscissa in ((axes[first], "generation"), (axes[first + across], "calls")):
            _draw(ax, study, results, cost, frame, abscissa)
    drawn = [ax for ax in axes if ax.has_data()]
    style.letter(drawn, [ax.get_title(loc="left") for ax in drawn])
    for ax in set(axes) - set(drawn):
        ax.set_axis_off()
    for row in range(2 * blocks):
        axes[row * across].set_ylabel("lowest cost so far [–]")
    style.legend_below(canvas, _entries(study))
    return canvas


def _draw(
    ax: Axes, study: Study, results: Results, cost: str, frame: pd.DataFrame, abscissa: str
) -> None:
    from matplotlib.ticker import MaxNLocator

    grid, found = minima_on_one_axis(frame, abscissa)
    by_calls = abscissa == "calls"
    look = style.cost_styles(study)[cost]
    area: DrawStyle = {"step": "post"} if by_calls else {}
    low, high = found.min(axis=0), found.max(axis=0)
    ax.fill_between(grid, low, high, color=look["color"], alpha=0.3, linewidth=0.0, **area)
    # A band of no width, where all repetitions agree, would not be seen.
    for edge in (low, high):
        ax.plot(grid, edge, color=look["color"], linewidth=0.4, **_steps(by_calls))
    ax.plot(grid, np.median(found, axis=0), color=look["color"], **_steps(by_calls))
    best = min(start.cost for start in searches.read_starts(study, results, cost, "least_squares"))
    levels = [best]
    ax.axhline(best, **_LS)
    theirs = published_mean(study, cost)
    if theirs is not None:
        levels.append(theirs)
        ax.axhline(theirs, **_PUBLISHED)
    _scale(ax, min(*levels, float(low.min())), max(*levels, float(high.max())))
    ax.set_title(cost, loc="left")
    ax.set_xlabel("model calls" if by_calls else "generation")
    ax.xaxis.set_major_locator(MaxNLocator(5, integer=True))


def published_mean(study: Study, cost: str) -> float | None:
    """Return the published mean fitness of a cost, None where there is none."""
    if study.published is None:
        return None
    fit = study.published.costs.get(cost, {}).get("fit")
    return None if fit is None else fit[1]


def _steps(by_calls: bool) -> DrawStyle:
    return {"drawstyle": "steps-post"} if by_calls else {}


def _scale(ax: Axes, low: float, high: float) -> None:
    """Set a logarithmic axis with plain numbers; linear within a factor 2, or down to zero."""
    from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

    if low <= 0.0 or high < 2.0 * low:
        margin = 0.06 * (high - low) or 0.1 * abs(high) or 1.0
        ax.set_ylim(low - margin, high + margin)
        return
    ax.set_yscale("log")
    margin = (high / low) ** 0.06
    ax.set_ylim(low / margin, high * margin)
    subs = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0) if high < 15.0 * low else (1.0, 2.0, 5.0)
    ax.yaxis.set_major_locator(LogLocator(10.0, subs=subs))
    ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    ax.yaxis.set_minor_locator(NullLocator())


def _entries(study: Study) -> list[Any]:
    entries = [
        style.line("median of the repetitions", color="0.3"),
        style.patch("lowest to highest", color="0.75"),
        style.line("least squares, best", **_LS),
    ]
    if any(published_mean(study, cost) is not None for cost in study.imp.costs):
        entries.append(style.line("published mean", **_PUBLISHED))
    return entries


FIGURE = Figure(
    place=20,
    make=fig5,
    title="Convergence of SCE-UA",
    paper="Figure 5",
    caption="Lowest cost found so far, from the lowest to the highest of the repetitions "
    "(area) and their median (line), by generation and by model calls. The scale is "
    "logarithmic and each cost function has its own: heights of different cost "
    "functions are not comparable. Where the dashed line, the best of least squares "
    "on the same cost, lies below the area, SCE-UA did not reach the lowest known "
    "cost. A narrow area alone is no proof of convergence.",
)
