"""Which input makes a signal vary at each time, and which cost sees which input."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from pyrofit.config import Study
from pyrofit.results import sensitivity
from pyrofit.results.files import Results
from pyrofit.results.sensitivity import OfSignal, Sensitivity
from pyrofit.show import style, units
from pyrofit.show.figure import Figure
from pyrofit.show.sensitivity.facts import curve, largest, over_time, short, shown, words
from pyrofit.show.table import always

HATCHES = ("", "////", "....", "\\\\\\\\", "xxxx", "----")


def total(study: Study, results: Results) -> Canvas:
    """Draw the total index of the inputs over time, with its interval."""
    found = sensitivity.read(study, results)
    names = largest(found)

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
    found = sensitivity.read(study, results)
    names = largest(found)

    def draw(ax: Axes, signal: OfSignal) -> None:
        table = over_time(results, signal).pivot(index="time_s", columns="input", values="first")
        shares = np.clip(table[names].to_numpy().T, 0.0, None)
        shares /= np.maximum(shares.sum(axis=0), 1.0)
        ends = np.cumsum(np.vstack([np.zeros(len(table)), shares]), axis=0)
        for i in range(len(names)):
            ax.fill_between(
                table.index,
                ends[i],
                ends[i + 1],
                facecolor=style.colour(i),
                alpha=0.55,
                hatch=HATCHES[i],
                edgecolor="white",
                linewidth=0.3,
            )
        ax.fill_between(table.index, ends[-1], 1.0, facecolor="0.93", linewidth=0.0)
        ax.set_ylim(0.0, 1.0)

    entries = [
        style.patch(
            short(found, name),
            facecolor=style.colour(i),
            alpha=0.55,
            hatch=HATCHES[i],
            edgecolor="white",
        )
        for i, name in enumerate(names)
    ]
    rest = style.patch("in combination, and others", facecolor="0.93")
    canvas = _panels(study, results, found, draw, "share of the variance [–]", mean=False)
    style.legend_below(canvas, [*entries, rest])
    return canvas


def _panels(
    study: Study, results: Results, found: Sensitivity, draw: object, label: str, mean: bool = True
) -> Canvas:
    """Draw a panel for every signal, with its mean curve over the sample."""
    assert callable(draw)
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
    frame = curve(results, signal)
    other = ax.twinx()
    other.plot(frame["time_s"], units.shown(quantity, frame["mean"]), color="0.6", linewidth=2.0)
    other.set_ylabel(f"mean [{quantity.shown.unit}]", color="0.4")
    other.tick_params(axis="y", colors="0.4")
    # The indices lie above the mean curve.
    ax.set_zorder(other.get_zorder() + 1)
    ax.patch.set_visible(False)
    ax.tick_params(right=False)


def costs(study: Study, results: Results) -> Canvas:
    """Draw the total index of every cost by input."""
    found = sensitivity.read(study, results)
    rows = shown(found)
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
    others = sum(one.kind == "estimated" for one in found.inputs)
    if 0 < others < len(names):
        ax.axvline(others - 0.5, color="white", linewidth=2.5)
    canvas.colorbar(image, ax=ax, label="total index [–]", shrink=0.9)
    return canvas


FIGURES = {
    "total": Figure(
        place=10,
        applies=always,
        make=total,
        title="What the signals depend on over time",
        caption="Total index of the inputs that matter most: share of the variance at a time in "
        "which an input takes part, alone or in combination. Bands: 95 % intervals of the "
        "bootstrap. Grey: mean curve over the sample. Gaps: the signal hardly varies.",
    ),
    "first": Figure(
        place=20,
        applies=always,
        make=first,
        title="Shares of the variance that inputs make alone",
        caption="Index of first order, stacked. What is left is made in combination: its causes "
        "cannot be told apart from this signal at this time.",
    ),
    "costs": Figure(
        place=30,
        applies=always,
        make=costs,
        title="Which cost sees which parameter",
        caption="Total index of every cost. Left of the white line estimated parameters, right of "
        "it what else is uncertain. Near 0: the cost does not change with the parameter. Costs "
        "that differ by a factor from one shown are left out.",
    ),
}
