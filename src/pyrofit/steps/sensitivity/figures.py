"""Which input makes a signal vary at each time, and which cost sees which input."""

from collections.abc import Callable, Sequence

import numpy as np

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style, units
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.steps.sensitivity import record
from pyrofit.steps.sensitivity.facts import (
    largest_inputs,
    mean_curve,
    names_of_estimated,
    others,
    over_time,
    short,
    shown_costs,
    words,
)
from pyrofit.steps.sensitivity.record import OfSignal, Sensitivity

HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----")


def draw_total(study: Study, results: Results) -> Canvas:
    """Draw the total index of the estimated parameters over time, with its interval."""
    return _total(study, results, names_of_estimated(record.read(study, results)))


def apparatus(study: Study, results: Results) -> Canvas:
    """Draw the same of the inputs that are not estimated."""
    return _total(study, results, others(record.read(study, results)))


def _total(study: Study, results: Results, among: Sequence[str]) -> Canvas:
    found = record.read(study, results)
    names = largest_inputs(found, among)

    def draw(ax: Axes, signal: OfSignal) -> None:
        frame = over_time(results, signal)
        for i, name in enumerate(names):
            own = frame[frame["input"] == name]
            band = own[["time_s", "total_low", "total_high"]].to_numpy().T
            ax.fill_between(*band, color=style.colour(i), alpha=0.2, linewidth=0.0)
            line = {"color": style.colour(i), "linestyle": style.dashes(i)}
            ax.plot(own["time_s"], own["total"], **line)
        ax.set_ylim(0.0, 1.1)

    entries = [
        style.line(short(found, name), color=style.colour(i), linestyle=style.dashes(i))
        for i, name in enumerate(names)
    ]
    canvas = _panels(study, results, found, draw, "total index [–]")
    style.legend_below(canvas, [*entries, style.line("mean curve", color="0.6")])
    return canvas


def first(study: Study, results: Results) -> Canvas:
    """Draw the shares of the variance that inputs make alone, stacked, over time."""
    found = record.read(study, results)
    rest = others(found)
    names = largest_inputs(found, names_of_estimated(found), len(HATCHES) - 1)

    def draw(ax: Axes, signal: OfSignal) -> None:
        table = over_time(results, signal).pivot(index="time_s", columns="input", values="first")
        parts = [*(table[name] for name in names), table[rest].sum(axis=1, skipna=False)]
        shares = np.clip(np.array(parts), 0.0, None)
        shares /= np.maximum(shares.sum(axis=0), 1.0)
        ends = np.cumsum(np.vstack([np.zeros(len(table)), shares]), axis=0)
        for i, look in enumerate(looks):
            ax.fill_between(table.index, ends[i], ends[i + 1], **look)
        ax.fill_between(table.index, ends[-1], 1.0, facecolor="0.93", linewidth=0.0)
        ax.set_ylim(0.0, 1.0)

    faces = [*(style.colour(i) for i in range(len(names))), "0.45"]
    hatches = [*HATCHES[: len(names)], HATCHES[-1]]
    looks: list[DrawStyle] = [
        {"facecolor": face, "hatch": hatch, "alpha": 0.6, "edgecolor": "white"}
        for face, hatch in zip(faces, hatches, strict=True)
    ]
    labels = [*(short(found, name) for name in names), "not estimated"]
    entries = [style.patch(label, **look) for label, look in zip(labels, looks, strict=True)]
    canvas = _panels(study, results, found, draw, "share of the variance [–]", mean=False)
    together = style.patch("in combination", facecolor="0.93")
    style.legend_below(canvas, [*entries, together])
    return canvas


def _panels(
    study: Study,
    results: Results,
    found: Sensitivity,
    draw: Callable[[Axes, OfSignal], None],
    label: str,
    mean: bool = True,
) -> Canvas:
    """Draw a panel for every signal, with its mean curve over the sample."""
    count = len(found.signals)
    canvas, axes = style.panels(count, 2, style.TWO_COLUMNS, 62.0)
    for ax, signal in zip(axes, found.signals, strict=True):
        if mean:
            _mean(study, results, ax, signal)
        draw(ax, signal)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(label)
    style.letter(axes, [words(study, (s.experiment, s.signal)) for s in found.signals])
    return canvas


def _mean(study: Study, results: Results, ax: Axes, signal: OfSignal) -> None:
    """Draw the mean curve behind the indices, with its own axis at the right."""
    quantity = study.experiments[signal.experiment].quantity(signal.signal)
    frame = mean_curve(results, signal)
    other = ax.twinx()
    other.plot(frame["time_s"], units.shown(quantity, frame["mean"]), color="0.6", linewidth=2.0)
    other.set_ylabel(f"mean [{quantity.shown.unit}]", color="0.4")
    other.tick_params(axis="y", colors="0.4")
    # The indices lie above the mean curve.
    ax.set_zorder(other.get_zorder() + 1)
    ax.patch.set_visible(False)
    ax.tick_params(right=False)


def draw_costs(study: Study, results: Results) -> Canvas:
    """Draw the total index of every cost by input."""
    found = record.read(study, results)
    rows = shown_costs(found)
    names = [one.name for one in found.inputs]
    table = np.array([[cost.total[name] for name in names] for cost in rows])
    width = min(style.TWO_COLUMNS, 48.0 + 9.5 * len(names))
    canvas, (ax,) = style.panels(1, 1, width, 34.0 + 5.5 * len(rows))
    image = ax.imshow(table, cmap="cividis_r", vmin=0.0, vmax=1.0, aspect="auto")
    for (i, k), value in np.ndenumerate(table):
        colour = "white" if value > 0.55 else "black"
        ax.text(k, i, f"{value:.2f}", ha="center", va="center", color=colour, fontsize=6.5)
    labels = [short(found, name) for name in names]
    ax.set_xticks(range(len(names)), labels, rotation=45, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(rows)), [cost.name for cost in rows])
    ax.tick_params(length=0)
    count = len(names_of_estimated(found))
    if count < len(names):
        ax.axvline(count - 0.5, color="white", linewidth=2.5)
    canvas.colorbar(image, ax=ax, label="total index [–]", shrink=0.9)
    return canvas


FIGURES = {
    "total": Figure(
        place=10,
        make=draw_total,
        title="On which estimated parameters the signals depend",
        caption="Total index of the parameters that matter most: share of the variance at a time "
        "in which a parameter takes part, alone or in combination. Bands: 95 % intervals of the "
        "bootstrap. Grey: mean curve over the sample. Gaps: the signal hardly varies.",
    ),
    "apparatus": Figure(
        place=15,
        make=apparatus,
        title="On which other values the signals depend",
        caption="The same of known values and of the apparatus, which vary within their "
        "uncertainty.",
    ),
    "first": Figure(
        place=20,
        make=first,
        title="Shares of the variance that inputs make alone",
        caption="Index of first order, stacked. The rest is made in combination: its causes "
        "cannot be told apart from this signal at this time.",
        shown=False,
    ),
    "costs": Figure(
        place=30,
        make=draw_costs,
        title="Which cost sees which parameter",
        caption="Total index of every cost. Left of the white line estimated parameters, right of "
        "it known values and the apparatus. Near 0: the cost does not change with the parameter. "
        "Costs that differ by a factor from one shown are left out.",
    ),
}
