"""Predicted signals as bands, and the distribution of each parameter."""

import numpy as np
import pandas as pd

from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import label_axes, label_of_axis
from pyrofit.show.drawn import Axes, Canvas, DrawStyle, Line2D, Patch
from pyrofit.show.figure import Figure
from pyrofit.show.units import shown
from pyrofit.solver.arrays import FloatArray
from pyrofit.steps.posterior import record
from pyrofit.steps.posterior.record import OfDraws

WIDE, DARK, NARROW = "#A9BED6", "#5C86B3", "#004488"
BINS = 40
_TRUTH: DrawStyle = {"color": style.COLOURS[1], "linewidth": 1.0, "linestyle": (0, (5, 1.5))}
Entries = list[Line2D | Patch]


def quantity_of(study: Study, experiment: str, signal: str) -> Quantity:
    """Return the quantity of a signal, or of one that nobody measured."""
    described = study.experiments[experiment]
    if signal in described.signals:
        return described.quantity(signal)
    return known_quantities()[signal]


def draw_bands(study: Study, results: Results) -> Canvas:
    """Draw measured signals and the bands of their predictions."""
    frame = record.read_predicted_bands(results)
    found = record.read(study, results)
    canvas, axes = style.panels(len(found.bands), 2, style.TWO_COLUMNS, 62.0)
    titles = [f"{title_of(study, of.experiment)}, {of.role}" for of in found.bands]
    style.letter(axes, titles)
    for ax, of in zip(axes, found.bands, strict=True):
        here = (frame["experiment"] == of.experiment) & (frame["signal"] == of.signal)
        _draw_bands(ax, study, frame[here])
    label_axes(axes, [_label(study, of) for of in found.bands])
    entries: Entries = [
        style.patch("95 %, with model discrepancy", color=WIDE),
        style.patch("95 %, parameters alone", color=DARK),
        style.line("median", color=NARROW, linewidth=0.9),
        style.line("data", color=style.MEASURED, linewidth=0.0, marker=".", markersize=2.0),
    ]
    style.legend_below(canvas, entries)
    return canvas


def _label(study: Study, of: record.OfBand) -> str:
    if of.role != "not measured":
        return label_of_axis(study, of.experiment, of.signal)
    quantity = quantity_of(study, of.experiment, of.signal)
    return f"{of.signal.replace('_', ' ')} [{quantity.shown.unit}]"


def _draw_bands(ax: Axes, study: Study, frame: pd.DataFrame) -> None:
    first = frame.iloc[0]
    quantity = quantity_of(study, str(first["experiment"]), str(first["signal"]))
    time = frame["time_s"]
    kinds = [("", WIDE), ("parameters_", DARK)]
    # The narrower band comes on top: in a fitted signal that is the one which was measured.
    for kind, colour in kinds if first["role"] != "fitted" else reversed(kinds):
        low, high = (shown(quantity, frame[f"{kind}{end}"]) for end in ("low", "high"))
        ax.fill_between(time, low, high, color=colour, linewidth=0.0)
    data = shown(quantity, frame["measured"].astype(float))
    ax.plot(time, data, color=style.MEASURED, linewidth=0.0, marker=".", markersize=1.2)
    ax.plot(time, shown(quantity, frame["median"]), color=NARROW, linewidth=0.9)


def draw_parameters(study: Study, results: Results) -> Canvas:
    """Draw the distribution of each parameter."""
    draws = record.samples(study, results)
    found = record.read(study, results).parameters
    canvas, axes = style.panels(len(found), 3, style.TWO_COLUMNS, 40.0)
    for ax, of in zip(axes, found, strict=True):
        _draw_parameter(ax, study, of, draws[of.name].to_numpy(float))
    style.letter(axes, [of.name for of in found])
    entries: Entries = [
        style.patch("draws", color=WIDE),
        style.line("mean and 95 % interval", color=NARROW, linewidth=1.4, marker="|"),
    ]
    if study.synthetic:
        entries.append(style.line("truth", **_TRUTH))
    style.legend_below(canvas, entries)
    return canvas


def _draw_parameter(ax: Axes, study: Study, of: OfDraws, draws: FloatArray) -> None:
    parameter = study.parameters[of.name]
    heights, _, _ = ax.hist(draws / parameter.factor, bins=BINS, color=WIDE, density=True)
    y = 0.08 * float(np.max(heights))
    low, mean, high = (value / parameter.factor for value in (of.low, of.mean, of.high))
    ax.plot([low, high], [y, y], color=NARROW, linewidth=1.4)
    ax.plot(mean, y, color=NARROW, marker="|", markersize=7.0)
    if study.synthetic and of.name in study.synthetic.truth:
        truth = study.synthetic.truth[of.name]
        ax.axvline(truth, **_TRUTH)
    ax.set_yticks([])
    ax.set_xlabel(f"{of.name} [{parameter.unit}]")


FIGURES = {
    "bands": Figure(
        place=10,
        make=draw_bands,
        title="Predicted signals with 95 % bands",
        caption="The dark band contains the uncertainty of the parameters alone. The light band "
        "includes the model discrepancy. Both are for the curve without noise. In a fitted signal "
        "the light band is narrower, because the data determine the sum of curve and discrepancy. "
        "The fit did not use 'held out' experiments.",
    ),
    "parameters": Figure(
        place=20,
        make=draw_parameters,
        title="Distribution of the parameters",
        caption="Draws from the posterior; bars: 95 % intervals, marks: means.",
    ),
}
