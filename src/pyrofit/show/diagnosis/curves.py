"""Measured and simulated curves before and after, with their residuals."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from pyrofit.analysis.running import running_mean
from pyrofit.analysis.uses import title_of
from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.curves import Look
from pyrofit.show.diagnosis.words import BASE, HELD_OUT, Found
from pyrofit.show.names import data_name

BEFORE: Look = {"color": style.COLOURS[1], "linestyle": style.DASHES[1], "linewidth": 1.1}


AFTER: Look = {"color": style.COLOURS[0], "linestyle": "-", "linewidth": 1.1}


_MEASURED: Look = {"color": style.MEASURED, "linewidth": 0.7}


_WINDOW: Look = {"facecolor": style.COLOURS[5], "alpha": 0.3, "linewidth": 0.0}


_EDGE: Look = {"color": "0.5", "linewidth": 0.4}


_LABELS = {
    "mlr": ("mass loss rate [g/(m² s)]", 1e3),
    "back_temperature": ("back temperature [K]", 1.0),
    "mass_fraction": ("mass fraction [–]", 1.0),
}


_LETTER = 0.019
"""Width of a letter of a window's label, as a fraction of a panel's."""


_ROWS = 3
"""Rows that labels of windows are put on, one after the other, where they would overlap."""


def of_signal(signal: str) -> Callable[[Study, Results], Canvas]:
    """Return the figure of a signal: curves above, residuals below, one pair per experiment."""
    return lambda study, results: _draw(study, results, signal)


def has(found: Found, signal: str) -> bool:
    """Tell whether the diagnosis looked at a signal."""
    return any(n["signal"] == signal for n in found["noise"])


def _draw(study: Study, results: Results, signal: str) -> Canvas:
    found = diagnosis.read(study, results)
    curves = diagnosis.curves(study, results)
    channels = [n for n in found["noise"] if n["signal"] == signal]
    canvas, pairs = _pairs(len(channels))
    style.letter([above for above, _ in pairs], [_title(study, n) for n in channels])
    for (above, below), channel in zip(pairs, channels, strict=True):
        here = (curves["experiment"] == channel["experiment"]) & (curves["signal"] == signal)
        curve = curves[here]
        windows = [
            w
            for w in found["windows"]
            if (w["model"], w["experiment"], w["signal"]) == (BASE, channel["experiment"], signal)
        ]
        x = "temperature_K" if signal == "mass_fraction" else "time_s"
        _draw_curves(above, curve, x, _LABELS[signal][1])
        _draw_residuals(below, curve, x)
        _draw_windows(below, windows, x)
        below.set_xlabel("temperature [K]" if x == "temperature_K" else "time [s]")
        if above.get_subplotspec().is_first_col():  # type: ignore[union-attr]
            above.set_ylabel(_LABELS[signal][0])
            below.set_ylabel("simulated −\nmeasured [sd]")
    data = data_name(study, [(n["experiment"], signal) for n in channels])
    after = any(_has_after(curves[curves["signal"] == signal]))
    style.legend_below(
        canvas, _entries(data, after, any(w["signal"] == signal for w in found["windows"]))
    )
    return canvas


def _pairs(count: int) -> tuple[Canvas, list[tuple[Axes, Axes]]]:
    """Return a canvas with pairs of panels, two pairs side by side."""
    columns = min(2, count)
    rows = -(-count // columns)
    width = style.TWO_COLUMNS if count > 1 else 130.0
    ratios = [1.7, 1.0] * rows
    canvas, axes = style.panels(2 * rows * columns, columns, width, 45.0, height_ratios=ratios)
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


def _title(study: Study, channel: Found) -> str:
    held = ", held out" if channel["role"] == HELD_OUT else ""
    return f"{title_of(study, channel['experiment'])}{held}"


def _has_after(curve: pd.DataFrame) -> pd.Series:
    """Tell where there is a curve with effects that differs from that of the base."""
    after = pd.to_numeric(curve["after"], errors="coerce")
    return after.notna() & (after != curve["before"])


def _draw_curves(ax: Axes, curve: pd.DataFrame, x: str, factor: float) -> None:
    at = curve[x].to_numpy(float)
    y, sd = (factor * curve[c].to_numpy(float) for c in ("measured", "sd"))
    ax.fill_between(at, y - 2.0 * sd, y + 2.0 * sd, color=style.BAND, linewidth=0.0)
    ax.plot(at, y, **_MEASURED)
    ax.plot(at, factor * curve["before"], **BEFORE)
    if _has_after(curve).any():
        ax.plot(at, factor * curve["after"].astype(float), **AFTER)


def _draw_residuals(ax: Axes, curve: pd.DataFrame, x: str) -> None:
    """Draw residuals in standard deviations: every point thin, their running mean bold."""
    at = curve[x].to_numpy(float)
    ax.axhspan(-2.0, 2.0, color=style.BAND, linewidth=0.0)
    style.zero_line(ax)
    looks = [("before", BEFORE)] + ([("after", AFTER)] if _has_after(curve).any() else [])
    for name, look in looks:
        r = (curve[name].astype(float) - curve["measured"]) / curve["sd"]
        ax.plot(at, r, color=look["color"], linewidth=0.4, alpha=0.4)
        ax.plot(at, running_mean(r), **look)


def _draw_windows(ax: Axes, windows: Sequence[Found], x: str) -> None:
    """Shade the windows, and label them with their phase, neighbours of one phase once."""
    low, high = ax.get_xlim()
    ends = "K" if x == "temperature_K" else "s"
    taken = np.full(_ROWS, -np.inf)
    last = ""
    for w in windows:
        start, end = float(w[f"start_{ends}"]), float(w[f"end_{ends}"])
        ax.axvspan(start, end, **_WINDOW)
        for edge in (start, end):
            ax.axvline(edge, **_EDGE)
        if w["phase"] == last:
            continue
        last = str(w["phase"])
        half = 0.5 * _LETTER * (len(last) + 1)
        middle = (0.5 * (start + end) - low) / (high - low)
        middle = float(np.clip(middle, half, 1.0 - half))
        row = next((i for i in range(_ROWS) if taken[i] < middle - half), _ROWS - 1)
        taken[row] = middle + half
        place: Look = {"transform": ax.transAxes, "ha": "center", "va": "top", "fontsize": 6}
        ax.text(middle, 0.975 - 0.12 * row, last, **place)
    if windows:  # room for the labels
        bottom, top = ax.get_ylim()
        ax.set_ylim(bottom, top + 0.18 * int((taken > 0.0).sum()) * (top - bottom))


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
        entries.append(style.patch("the base model is off", **look))
    return entries


CAPTION = (
    "Above: measured with twice the standard deviation of its noise, the base model, and the model "
    "with the effects found, if any. Below: simulated minus measured in standard deviations, every "
    "point (thin) and the running mean over 3 % of the points (bold). Shaded stretches are those "
    "where the base model is off to one side by more than noise would be, with their phase."
)
