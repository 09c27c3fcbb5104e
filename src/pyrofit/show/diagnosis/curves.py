"""Measured and simulated curves before and after, with their residuals."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.analysis.running import smoothed
from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.quantities.base import FloatArray, Quantity
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import Diagnosis, OfNoise, OfWindow
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.diagnosis.words import BASE, HELD_OUT, quantity_of_row, words_of
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure
from pyrofit.show.names import data_name
from pyrofit.show.units import celsius, shown

BEFORE: DrawStyle = {"color": style.COLOURS[1], "linestyle": style.DASHES[1], "linewidth": 1.1}


AFTER: DrawStyle = {"color": style.COLOURS[0], "linestyle": "-", "linewidth": 1.1}


_MEASURED: DrawStyle = {"color": style.MEASURED, "linewidth": 0.7}


_WINDOW: DrawStyle = {"facecolor": style.COLOURS[5], "alpha": 0.3, "linewidth": 0.0}


_EDGE: DrawStyle = {"color": "0.5", "linewidth": 0.4}


_LETTER = 0.019
"""Width of a letter of a window's label, as a fraction of a panel's."""


_ROWS = 3
"""Rows that labels of windows are put on, one after the other, where they would overlap."""


CAPTION = (
    "Above: measured with twice the standard deviation of its noise, the base model, and the model "
    "with the effects found, if any. Below: simulated minus measured, divided by the standard "
    "deviation; the correlation is not removed. Thin: every point; bold: the running mean over 3 % "
    "of the points. Shaded: intervals with significant residuals of the base model, and "
    "their phase."
)


def curve_figures(study: Study, found: Diagnosis) -> dict[str, Figure]:
    """Return a figure for each quantity that the diagnosis looked at, rates first, TGA last."""
    measured = {(q := quantity_of_row(study, n)).name: q for n in found.noise}
    order = sorted(measured.values(), key=lambda q: (q.against_temperature, not q.relative))
    return {
        quantity.title.replace(" ", "_"): Figure(
            place=110 + i,
            make=partial(_draw, quantity=quantity),
            title=f"{quantity.title.capitalize()}, before and after",
            caption=CAPTION,
        )
        for i, quantity in enumerate(order)
    }


def _draw(study: Study, results: Results, quantity: Quantity) -> Canvas:
    """Draw curves above, residuals below, one pair of panels for each signal of a quantity."""
    found = diagnosis.read(study, results)
    curves = diagnosis.read_curves(study, results)
    signals = [n for n in found.noise if quantity_of_row(study, n).name == quantity.name]
    canvas, pairs = pairs_of_axes(len(signals))
    style.letter([above for above, _ in pairs], [_title(study, n) for n in signals])
    x = "temperature_K" if quantity.against_temperature else "time_s"
    after = windows = False
    for axes, signal in zip(pairs, signals, strict=True):
        curve = curves[
            (curves["experiment"] == signal.experiment) & (curves["signal"] == signal.signal)
        ]
        off = [w for w in found.windows if w.model == BASE and _same(w, signal)]
        _draw_pair(axes, curve, off, quantity, x)
        after = after or bool(_has_after(curve).any())
        windows = windows or any(_same(w, signal) for w in found.windows)
    data = data_name(study, [(n.experiment, n.signal) for n in signals])
    style.legend_below(canvas, _entries(data, after, windows))
    return canvas


def _same(one: OfNoise | OfWindow, other: OfNoise | OfWindow) -> bool:
    """Tell whether two rows are of the same signal."""
    return (one.experiment, one.signal) == (other.experiment, other.signal)


def _draw_pair(
    axes: tuple[Axes, Axes],
    curve: pd.DataFrame,
    off: Sequence[OfWindow],
    quantity: Quantity,
    x: str,
) -> None:
    above, below = axes
    at = celsius(curve[x]) if quantity.against_temperature else curve[x].to_numpy(float)
    _draw_curves(above, at, curve, quantity)
    _draw_residuals(below, at, curve)
    _draw_windows(below, off, x)
    below.set_xlabel("temperature [°C]" if quantity.against_temperature else "time [s]")
    if above.get_subplotspec().is_first_col():  # type: ignore[union-attr]
        above.set_ylabel(quantity.label)
        below.set_ylabel("simulated −\nmeasured [sd]")


def pairs_of_axes(count: int) -> tuple[Canvas, list[tuple[Axes, Axes]]]:
    """Return a canvas with pairs of panels, two pairs side by side, three of many."""
    most, height = (2, 45.0) if 4 * -(-count // 2) <= style.MANY else (style.MOST_COLUMNS, 36.0)
    columns = min(most, count)
    rows = -(-count // columns)
    width = style.TWO_COLUMNS if count > 1 else 130.0
    ratios = [1.7, 1.0] * rows
    canvas, axes = style.panels(2 * rows * columns, columns, width, height, height_ratios=ratios)
    pairs = []
    for i in range(rows * columns):
        at = 2 * columns * (i // columns) + i % columns
        above, below = axes[at], axes[at + columns]
        if i >= count:
            above.set_axis_off()
            below.set_axis_off()
            continue
        below.sharex(above)
        above.tick_params(labelbottom=False)
        pairs.append((above, below))
    return canvas, pairs


def _title(study: Study, row: OfNoise) -> str:
    held = ", held out" if row.role == HELD_OUT else ""
    words = words_of(study, row)
    named = "" if words == quantity_of_row(study, row).title else f", {words}"
    return f"{title_of(study, row.experiment)}{named}{held}"


def _has_after(curve: pd.DataFrame) -> pd.Series:
    """Tell where there is a curve with effects that differs from that of the base."""
    after = pd.to_numeric(curve["after"], errors="coerce")
    return after.notna() & (after != curve["before"])


def _draw_curves(ax: Axes, at: FloatArray, curve: pd.DataFrame, quantity: Quantity) -> None:
    measured, sd = (curve[c].to_numpy(float) for c in ("measured", "sd"))
    low, high = (shown(quantity, measured + side * 2.0 * sd) for side in (-1.0, 1.0))
    ax.fill_between(at, low, high, color=style.BAND, linewidth=0.0)
    ax.plot(at, shown(quantity, measured), **_MEASURED)
    ax.plot(at, shown(quantity, curve["before"]), **BEFORE)
    if _has_after(curve).any():
        ax.plot(at, shown(quantity, curve["after"]), **AFTER)


def _draw_residuals(ax: Axes, at: FloatArray, curve: pd.DataFrame) -> None:
    """Draw residuals in standard deviations: every point thin, their running mean bold."""
    ax.axhspan(-2.0, 2.0, color=style.BAND, linewidth=0.0)
    style.zero_line(ax)
    looks = [("before", BEFORE)] + ([("after", AFTER)] if _has_after(curve).any() else [])
    for name, look in looks:
        r = (curve[name].astype(float) - curve["measured"]) / curve["sd"]
        ax.plot(at, r, color=look["color"], linewidth=0.4, alpha=0.4)
        ax.plot(at, smoothed(r), **look)


def _draw_windows(ax: Axes, windows: Sequence[OfWindow], x: str) -> None:
    """Shade the windows, and label them with their phase, neighbours of one phase once."""
    low, high = ax.get_xlim()
    taken = np.full(_ROWS, -np.inf)
    last = ""
    for w in windows:
        start, end = _ends(w, x)
        ax.axvspan(start, end, **_WINDOW)
        for edge in (start, end):
            ax.axvline(edge, **_EDGE)
        if w.phase == last:
            continue
        last = w.phase
        half = 0.5 * _LETTER * (len(last) + 1)
        middle = (0.5 * (start + end) - low) / (high - low)
        middle = float(np.clip(middle, half, 1.0 - half))
        row = next((i for i in range(_ROWS) if taken[i] < middle - half), _ROWS - 1)
        taken[row] = middle + half
        place: DrawStyle = {"transform": ax.transAxes, "ha": "center", "va": "top", "fontsize": 6}
        ax.text(middle, 0.975 - 0.12 * row, last, **place)
    if windows:  # room for the labels
        bottom, top = ax.get_ylim()
        ax.set_ylim(bottom, top + 0.18 * int((taken > 0.0).sum()) * (top - bottom))


def _ends(window: OfWindow, x: str) -> tuple[float, float]:
    """Return both ends of a window on the axis: time [s], or temperature [°C]."""
    if x != "temperature_K":
        return window.start_s, window.end_s
    assert window.start_K is not None
    assert window.end_K is not None
    return window.start_K - ICE_POINT_K, window.end_K - ICE_POINT_K


def _entries(data: str, after: bool, windows: bool) -> list[Any]:
    entries: list[Any] = [
        style.line(data, **_MEASURED),
        style.patch("± 2 sd of the noise", color=style.BAND),
        style.line("base model", **BEFORE),
    ]
    if after:
        entries.append(style.line("with the effects found", **AFTER))
    if windows:
        look = {"facecolor": _WINDOW["facecolor"], "alpha": _WINDOW["alpha"]}
        entries.append(style.patch("significant residuals of the base model", **look))
    return entries
