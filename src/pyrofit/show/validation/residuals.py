"""Residuals of the mass loss rate."""

from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.running import running_mean
from pyrofit.analysis.uses import SCEUA, predicted, predicted_sets
from pyrofit.config import Study
from pyrofit.results import recorded
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import (
    MLR_LABEL,
    curve_of,
    draw_band,
    grams,
    label_axes,
    look_of,
    measured_entries,
    panels_of,
    predicted_curves,
    set_entries,
)
from pyrofit.show.figure import Figure
from pyrofit.show.names import data_name


def residuals(study: Study, results: Results) -> Canvas:
    """Draw simulated minus measured mass loss rate over time, with the uncertainty about zero."""
    names = predicted(study, "mlr")
    canvas, axes = panels_of(study, names)
    curves = predicted_curves(study, results)
    shown = [s for s in predicted_sets(study) if s.origin == SCEUA]
    for ax, name in zip(axes, names, strict=True):
        draw_band(ax, recorded.series(study, results, name, "mlr"), "mlr", grams, about_zero=True)
        style.zero_line(ax)
        for chosen in shown:
            curve = curve_of(curves, name, "mlr", chosen.label)
            difference = curve["simulated"] - curve["measured"]
            look = look_of(study, chosen)
            points = {"color": look["color"], "linewidth": 0.4, "alpha": 0.4}
            ax.plot(curve["time_s"], grams(difference), **points)
            ax.plot(curve["time_s"], grams(running_mean(difference)), **look)
    data = data_name(study, [(name, "mlr") for name in names])
    label_axes(axes, f"simulated − {data}\n{MLR_LABEL}")
    entries = measured_entries(study, results, names, "mlr", with_line=False)
    style.legend_below(canvas, [*entries, *set_entries(study, shown)])
    return canvas


FIGURE = Figure(
    place=20,
    applies=lambda study: bool(predicted(study, "mlr")),
    make=residuals,
    title="Residuals of the mass loss rate",
    caption="Mass loss rate of the best sets minus that of the data: every point (thin) and "
    "the running mean over 3 % of the points (bold), and the uncertainty of the data "
    "about zero (grey area). Noise scatters about zero; long stretches on one side are "
    "systematic.",
)
