"""Measured, fitted and predicted at a glance."""

import pandas as pd

from pyrofit.analysis.uses import ESTIMATES, FITTED, HELD_OUT, LIKELIHOOD, title_of, use_of
from pyrofit.config import Study
from pyrofit.results import recorded
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import (
    Pair,
    curve_of_set,
    draw_band,
    label_axes,
    label_of_axis,
    measured_entries,
    predicted_curves,
    tests_of,
)
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.units import shown
from pyrofit.show.verdicts import verdict_on

_MOST = 2
"""Tests of each use that are shown."""
_LINE: DrawStyle = {"color": style.ESTIMATES, "linewidth": 1.1}


def draw_overview(study: Study, results: Results) -> Canvas:
    """Draw the first fitted and held-out tests with the estimates."""
    curves = predicted_curves(study, results)
    pairs = _pairs(study)
    canvas, axes = style.panels(len(pairs), 2, style.TWO_COLUMNS, 62.0)
    uses = {FITTED: "fitted", HELD_OUT: "predicted"}
    style.letter(axes, [f"{uses[_use(study, pair)]}: {title_of(study, pair[0])}" for pair in pairs])
    for ax, pair in zip(axes, pairs, strict=True):
        _draw(ax, study, results, pair, curve_of_set(curves, *pair, ESTIMATES))
    label_axes(axes, [label_of_axis(study, *pair) for pair in pairs])
    style.legend_below(
        canvas,
        [
            *measured_entries(study, results, pairs, with_line=True),
            style.line(ESTIMATES, **_LINE),
        ],
    )
    return canvas


def _draw(ax: Axes, study: Study, results: Results, pair: Pair, curve: pd.DataFrame) -> None:
    name, signal = pair
    quantity = study.experiments[name].quantity(signal)
    measured = recorded.series(study, results, name, signal)
    draw_band(ax, measured, quantity)
    value = shown(quantity, measured[quantity.column])
    ax.plot(measured["time_s"], value, color=style.MEASURED, linewidth=0.7)
    ax.plot(curve["time_s"], shown(quantity, curve["simulated"]), **_LINE)


def _use(study: Study, pair: Pair) -> str:
    """Return the use of a signal: 'fitted' where a cost function or the estimates use it."""
    uses = {use_of(study, cost, *pair) for cost in (LIKELIHOOD, *study.imp.costs)}
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
    make=draw_overview,
    title="Measured, fitted and predicted",
    caption="The estimates beside the data. 'Predicted': nothing was fitted to this test.",
    verdict=lambda study, facts: verdict_on(study, facts, "imp", _pairs(study)),
)
