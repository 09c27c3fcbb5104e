"""Residuals of the predicted rates."""

from pyrofit.analysis.running import smoothed
from pyrofit.analysis.uses import PUBLISHED, predicted_signals
from pyrofit.config import Study
from pyrofit.results import recorded
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import (
    curve_of_set,
    draw_band,
    label_axes,
    label_of_axis,
    look_of,
    measured_entries,
    panels_of,
    predicted_curves,
    set_entries,
    sets_beside_data,
)
from pyrofit.show.drawn import Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.names import data_name
from pyrofit.show.units import difference
from pyrofit.show.verdicts import verdict_on


def draw_residuals_over_time(study: Study, results: Results) -> Canvas:
    """Draw simulated minus measured rates over time, with the uncertainty about zero."""
    pairs = predicted_signals(study, relative=True)
    canvas, axes = panels_of(study, pairs)
    curves = predicted_curves(study, results)
    sets = [s for s in sets_beside_data(study) if s.origin != PUBLISHED]
    for ax, (name, signal) in zip(axes, pairs, strict=True):
        quantity = study.experiments[name].quantity(signal)
        draw_band(ax, recorded.series(study, results, name, signal), quantity, about_zero=True)
        style.zero_line(ax)
        for chosen in sets:
            curve = curve_of_set(curves, name, signal, chosen.label)
            off = curve["simulated"] - curve["measured"]
            look = look_of(study, chosen)
            points: DrawStyle = {"color": look["color"], "linewidth": 0.4, "alpha": 0.4}
            ax.plot(curve["time_s"], difference(quantity, off), **points)
            ax.plot(curve["time_s"], difference(quantity, smoothed(off)), **look)
    data = data_name(study, pairs)
    label_axes(axes, [f"simulated − {data}\n{label_of_axis(study, *pair)}" for pair in pairs])
    entries = measured_entries(study, results, pairs, with_line=False)
    style.legend_below(canvas, [*entries, *set_entries(study, sets)])
    return canvas


FIGURE = Figure(
    place=20,
    applies=lambda study: bool(predicted_signals(study, relative=True)),
    make=draw_residuals_over_time,
    verdict=lambda study, facts: verdict_on(
        study, facts, "imp", predicted_signals(study, relative=True)
    ),
    title="Residuals of the rates",
    caption="Simulated mass loss rate or heat release rate minus that of the "
    "data. Thin: every point; bold: running mean over 3 % of the points; grey area: "
    "uncertainty of the data about zero. Noise scatters about zero; long stretches on "
    "one side are systematic.",
)
