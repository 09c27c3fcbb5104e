"""The figures of the blind test, drawn from the table of all twins."""

from collections.abc import Callable

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import FormatStrFormatter, LogLocator, NullFormatter

from pyrofit.effects import known_effects
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import DrawStyle
from pyrofit_blind_test.places import Places
from pyrofit_blind_test.power_figure import power_by_effect
from pyrofit_blind_test.rates import SHARES, by_detectability, rate_interval
from pyrofit_blind_test.table import one_name

OTHER = ("ambiguous", "multiple", "partly", "unknown", "none")
"""Verdicts that do not name one effect, the last columns of the confusion matrix."""
MARKERS = ("o", "s", "^", "D")
_FALSE_ALARM_TARGET = 0.02


def confusion(twins: pd.DataFrame) -> Canvas:
    """Draw the verdict against the hidden effect: numbers of twins with one hidden effect."""
    single = twins[twins["kind"] == "effect"]
    names = _sorted_names()
    columns = [*names, *OTHER]
    counts = np.zeros((len(names), len(columns)), dtype=int)
    for row in single.itertuples():
        column = one_name(str(row.named)) if row.verdict == "named" else str(row.verdict)
        counts[names.index(one_name(str(row.hidden))), columns.index(column)] += 1
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 150.0)
    shown = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    ax.imshow(shown, cmap="Blues", vmin=0.0, vmax=1.3, aspect="auto")
    for i, k in zip(*np.nonzero(counts), strict=True):
        bold = "bold" if i == k else "normal"
        color = "white" if shown[i, k] > 0.6 else "black"
        number = str(counts[i, k])
        ax.text(k, i, number, ha="center", va="center", fontsize=6, weight=bold, color=color)
    _lines_between_groups(ax, names)
    ax.set_xticks(range(len(columns)), columns, rotation=90, fontsize=6)
    ax.set_yticks(range(len(names)), names, fontsize=6)
    ax.tick_params(length=0)
    ax.set_xlabel("verdict")
    ax.set_ylabel("hidden effect")
    return canvas


def _sorted_names() -> list[str]:
    """Return the effects by group; effects that no signal can distinguish share one name."""
    catalogue = known_effects()
    groups = list(dict.fromkeys(e.group for e in catalogue.values()))
    names = dict.fromkeys(one_name(name) for name in catalogue)
    return sorted(names, key=lambda name: (groups.index(catalogue[name].group), name))


def _lines_between_groups(ax: Axes, names: list[str]) -> None:
    catalogue = known_effects()
    groups = [catalogue[name].group for name in names]
    for i in range(1, len(names)):
        if groups[i] != groups[i - 1]:
            ax.axhline(i - 0.5, color="0.8", linewidth=0.4)
            ax.axvline(i - 0.5, color="0.8", linewidth=0.4)
    ax.axvline(len(names) - 0.5, color="black", linewidth=0.8)


def accuracy(twins: pd.DataFrame) -> Canvas:
    """Draw the shares claimed and rightly named against detectability, with 95 % intervals."""
    shares = by_detectability(twins)
    canvas, (ax,) = style.panels(1, 1, style.ONE_COLUMN + 25.0, 75.0)
    classes = shares.drop_duplicates("from_sd")
    for i, what in enumerate(SHARES):
        part = shares[shares["share"] == what].reset_index(drop=True)
        _with_intervals(ax, part, i, len(SHARES), what)
    labels = [
        f"{low:g} to {high:g}\nn = {count}" if np.isfinite(high) else f"over {low:g}\nn = {count}"
        for low, high, count in classes[["from_sd", "to_sd", "twins"]].itertuples(index=False)
    ]
    ax.set_xticks(range(len(labels)), labels)
    ax.set_xlim(-0.5, len(labels) - 0.5)
    ax.set_ylim(-0.03, 1.03)
    ax.set_xlabel("detectability [standard deviations of the noise]")
    ax.set_ylabel("share of twins [–]")
    style.legend_below(canvas, [style.line(what, **_look(i)) for i, what in enumerate(SHARES)])
    return canvas


def false_alarms(twins: pd.DataFrame) -> Canvas:
    """Draw the rate of false alarms, claims on twins without a hidden effect, by noise."""
    nulls = twins[twins["kind"] == "null"]
    noises, sets = sorted(nulls["noise"].unique()), [*sorted(nulls["signals"].unique()), "all"]
    canvas, (ax,) = style.panels(1, 1, style.ONE_COLUMN + 25.0, 65.0)
    for i, signals in enumerate(sets):
        rows = []
        for noise in noises:
            seen = (nulls["signals"] == signals) | (signals == "all")
            here = nulls[(nulls["noise"] == noise) & seen]["claim"]
            hits, count = int(here.sum()), len(here)
            low, high = rate_interval(hits, count) if count else (np.nan, np.nan)
            share = hits / count if count else np.nan
            rows.append({"rate": share, "low": low, "high": high})
        _with_intervals(ax, pd.DataFrame(rows), i, len(sets), signals)
    ax.axhline(_FALSE_ALARM_TARGET, color="black", linewidth=0.7)
    counts = nulls["noise"].value_counts()
    ax.set_xticks(range(len(noises)), [f"{noise}\nn = {counts[noise]}" for noise in noises])
    ax.set_xlim(-0.5, len(noises) - 0.5)
    ax.set_ylim(bottom=-0.01)
    ax.set_xlabel("noise")
    ax.set_ylabel("share claimed,\nno hidden effect [–]")
    entries = [style.line(signals, **_look(i)) for i, signals in enumerate(sets)]
    entries.append(style.line("2 %", color="black", linewidth=0.7))
    style.legend_below(canvas, entries)
    return canvas


def _look(i: int) -> DrawStyle:
    return {"color": style.colour(i), "marker": MARKERS[i], "markersize": 4, "linestyle": "none"}


def _with_intervals(ax: Axes, part: pd.DataFrame, i: int, of: int, label: str) -> None:
    """Draw rates and their intervals, the i-th of several beside each other."""
    x = np.arange(len(part)) + 0.16 * (i - 0.5 * (of - 1))
    rate = part["rate"].to_numpy(float)
    seen = np.isfinite(rate)
    below, above = rate - part["low"].to_numpy(float), part["high"].to_numpy(float) - rate
    error = np.vstack([below, above])[:, seen]
    ax.errorbar(x[seen], rate[seen], error, **_look(i), elinewidth=0.9, label=label)


def gaps(twins: pd.DataFrame) -> Canvas:
    """Draw the gap between model and measurement before and after, fitted and held out."""
    claimed = twins[(twins["kind"] == "effect") & twins["claim"]]
    canvas, axes = style.panels(2, 2, style.TWO_COLUMNS, 82.0)
    style.letter(axes, ["fitted signals", "held-out signals"])
    looks = (("name right", True), ("name wrong", False))
    for ax, role in zip(axes, ("calibration", "held_out"), strict=True):
        before, after = claimed[f"{role}_before"], claimed[f"{role}_after"]
        for i, (_, right) in enumerate(looks):
            # Wrong names are few: drawn last, none is covered.
            part = claimed["right"] == right
            ax.plot(before[part], after[part], **_look(i), alpha=0.75, zorder=2 + i)
        both = pd.concat([before, after]).dropna()
        low, high = (both.min() / 1.2, both.max() * 1.2) if len(both) else (0.5, 2.0)
        ax.plot([low, high], [low, high], color="0.4", linewidth=0.7)
        ax.set(xscale="log", yscale="log", xlim=(low, high), ylim=(low, high))
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(FormatStrFormatter("%g"))
            axis.set_minor_formatter(NullFormatter())
        ax.set_xlabel("rms of whitened residuals, base model [–]")
        ax.set_ylabel("the same, with the named effect [–]")
    entries = [style.line(words, **_look(i)) for i, (words, _) in enumerate(looks)]
    style.legend_below(canvas, [*entries, style.line("unchanged", color="0.4", linewidth=0.7)])
    return canvas


def draw_set_sizes(twins: pd.DataFrame) -> Canvas:
    """Draw the sizes of the sets of claimed effects, and the gain of held-out predictions."""
    claimed = twins[(twins["kind"] == "effect") & twins["claim"]]
    canvas, axes = style.panels(2, 2, style.TWO_COLUMNS, 75.0)
    style.letter(axes, ["effects not distinguished", "held-out prediction"])
    axes[1].set_xscale("log")
    axes[1].set_yscale("symlog", linthresh=2.0)
    looks = (("hidden effect in the set", True), ("hidden effect not in the set", False))
    sizes = np.arange(1, 1 + int(np.ceil(claimed["set_size"].max())) if len(claimed) else 2)
    below = np.zeros(sizes.size)
    for i, (_, inside) in enumerate(looks):
        of = np.ceil(claimed[claimed["in_set"] == inside]["set_size"])
        counts = np.array([np.sum(of == size) for size in sizes])
        hatch = "" if inside else "////"
        axes[0].bar(sizes, counts, bottom=below, color=style.colour(i), hatch=hatch, width=0.7)
        part = claimed[(claimed["in_set"] == inside) & claimed["held_out_gain"].notna()]
        axes[1].plot(part["detectability"], part["held_out_gain"], **_look(i), alpha=0.75)
        below += counts
    axes[0].set_xticks(sizes)
    axes[0].set_xlim(0.3, sizes[-1] + 0.7)
    axes[0].set_ylim(top=1.05 * max(below.max(), 1.0))
    axes[1].margins(0.05)
    axes[0].set_xlabel("effects in the set")
    axes[0].set_ylabel("twins")
    axes[1].axhline(0.0, color="0.4", linewidth=0.7)
    axes[1].set_xlabel("detectability [standard deviations]")
    axes[1].set_ylabel("gain of the log score [–]")
    style.legend_below(
        canvas, [style.line(words, **_look(i)) for i, (words, _) in enumerate(looks)]
    )
    return canvas


FIGURES: dict[str, tuple[Callable[[pd.DataFrame], Canvas], str]] = {
    "confusion": (
        confusion,
        "Verdict against hidden effect: numbers of twins with one hidden effect. Lines separate "
        "groups of similar effects.",
    ),
    "accuracy": (
        accuracy,
        "Shares of effects claimed and rightly named against detectability, with 95 % intervals. "
        "For comparison: the largest score, which needs no fit and always gives a name.",
    ),
    "power": (
        power_by_effect,
        "Detectability from which half and nine tenths of the twins are rightly named, over all "
        "effects and by effect, with 95 % intervals.",
    ),
    "false_alarms": (
        false_alarms,
        "Share of twins without a hidden effect for which one is claimed, by kind of noise, with "
        "95 % intervals.",
    ),
    "gaps": (
        gaps,
        "Root mean square of the whitened residuals before and after the named effect was added. "
        "Noise alone gives 1. Points below the line are improvements.",
    ),
    "sets": (
        draw_set_sizes,
        "Number of effects that a claim cannot distinguish, and gain of the log score of the "
        "held-out prediction by the claimed effect against detectability.",
    ),
}
"""How each figure is drawn, and its caption."""


def draw_blind_test(twins: pd.DataFrame, places: Places) -> None:
    """Write all figures to ``figures/<name>.svg`` and ``.png``."""
    with style.style():
        for name, (make, _) in FIGURES.items():
            style.save(make(twins), Results(places.root), name)
