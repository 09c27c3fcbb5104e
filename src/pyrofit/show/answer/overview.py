"""Measured, fitted and predicted at a glance."""

from typing import Any

import pandas as pd

from pyrofit.analysis.uses import (
    FITTED,
    HELD_OUT,
    PredictedSet,
    predicted_sets,
    title_of,
    use_of,
)
from pyrofit.config import Study
from pyrofit.results import comparison, recorded
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.answer.chosen import chosen_set
from pyrofit.show.curves import (
    Pair,
    curve_of,
    draw_band,
    label_axes,
    label_of,
    measured_entries,
    predicted_curves,
    tests_of,
)
from pyrofit.show.drawn import Axes, Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.units import shown

_MOST = 2
"""Tests of each use that are shown."""
_REACH: dict[str, Any] = {"color": "#9ecae1", "linewidth": 0.0}
_LINE: dict[str, Any] = {"color": "#08519c", "linewidth": 1.1}


def overview(study: Study, results: Results) -> Canvas:
    """Draw the first fitted and held-out tests with the recommended set and the good sets."""
    chosen = _recommended(study, results)
    reach = comparison.bands(study, results)
    curves = predicted_curves(study, results)
    pairs = _pairs(study)
    canvas, axes = style.panels(len(pairs), 2, style.TWO_COLUMNS, 62.0)
    uses = {FITTED: "fitted", HELD_OUT: "predicted"}
    style.letter(axes, [f"{uses[_use(study, pair)]}: {title_of(study, pair[0])}" for pair in pairs])
    for ax, pair in zip(axes, pairs, strict=True):
        _draw(ax, study, results, pair, reach, curve_of(curves, *pair, chosen.label))
    label_axes(axes, [label_of(study, *pair) for pair in pairs])
    style.legend_below(
        canvas,
        [
            *measured_entries(study, results, pairs, with_line=True),
            style.line(f"recommended set ({chosen.cost}, {chosen.origin})", **_LINE),
            style.patch("sets near the lowest cost", color=_REACH["color"]),
        ],
    )
    return canvas


def _draw(
    ax: Axes, study: Study, results: Results, pair: Pair, reach: pd.DataFrame, curve: pd.DataFrame
) -> None:
    name, signal = pair
    quantity = study.experiments[name].quantity(signal)
    measured = recorded.series(study, results, name, signal)
    draw_band(ax, measured, quantity)
    around = reach[(reach["experiment"] == name) & (reach["signal"] == signal)]
    # The last one is around those of all cost functions, where there are several.
    around = around[around["cost_function"] == around["cost_function"].iloc[-1]]
    low, high = (shown(quantity, around[end]) for end in ("low", "high"))
    ax.fill_between(around["time_s"], low, high, **_REACH)
    value = shown(quantity, measured[quantity.column])
    ax.plot(measured["time_s"], value, color=style.MEASURED, linewidth=0.7)
    ax.plot(curve["time_s"], shown(quantity, curve["simulated"]), **_LINE)


def _recommended(study: Study, results: Results) -> PredictedSet:
    chosen = chosen_set(study, results)
    mine = (chosen.cost_function, chosen.found_by)
    return next(one for one in predicted_sets(study) if (one.cost, one.origin) == mine)


def _use(study: Study, pair: Pair) -> str:
    """Return the use that any cost function makes of a signal: 'fitted' where one is fitted."""
    uses = {use_of(study, cost, *pair) for cost in study.imp.costs}
    return FITTED if FITTED in uses else min(uses)


def _pairs(study: Study) -> list[Pair]:
    """Return the first repeats of the first tests that are fitted, then of those held out."""
    every = [
        (name, signal)
        for name in study.validation.experiments
        for signal in study.experiments[name].signals
    ]
    fitted = [pair for pair in every if _use(study, pair) == FITTED]
    kinds = {signal for _, signal in fitted}
    held_out = [p for p in every if _use(study, p) == HELD_OUT and (not kinds or p[1] in kinds)]
    return [
        group[0] for group in (*tests_of(study, fitted)[:_MOST], *tests_of(study, held_out)[:_MOST])
    ]


FIGURE = Figure(
    place=5,
    applies=lambda study: bool(_pairs(study)),
    make=overview,
    title="Measured, fitted and predicted",
    caption="The recommended set, and the lowest and highest curve of all sets whose cost is near "
    "the lowest known one. The recommended set is chosen by held-out tests, if there are any; it "
    "may lie outside. 'Predicted': no cost function was fitted to this test.",
)
