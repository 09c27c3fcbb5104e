"""The figure of a case: both curves above, their difference below; or errors against sizes."""

import io
from typing import Any

import numpy as np
from evidence import Case, Curve, Picture
from matplotlib.axes import Axes
from matplotlib.ticker import NullLocator
from PIL import Image

from pyrofit.show.style import colour, dashes, legend_below, line, panels, style, zero_line

WIDTH, ROW, SINGLE = 140.0, 42.0, 84.0
"""Sizes [mm]: a figure's width, a row's height of two, the height of a single panel."""
DPI = 110
TINTS = 48
FEW = 30
"""Points up to which the other curve is drawn as points."""
OTHER: dict[str, Any] = {"color": "0.65", "linewidth": 3.2, "solid_capstyle": "butt"}
POINTS: dict[str, Any] = {"color": "0.45", "linestyle": "none", "marker": "o", "markersize": 4.5}
MARKERS = "os^Dv<>"


def png(case: Case) -> bytes:
    """The figure of a case; equal curves give equal bytes."""
    assert case.picture is not None
    draw = _two_curves if case.picture.order is None else _errors
    with style():
        figure = draw(case.picture)
        figure.set_dpi(DPI)
        figure.canvas.draw()
        pixels = np.asarray(figure.canvas.buffer_rgba())
    # A palette takes a third of the bytes and looks the same.
    image = Image.fromarray(pixels).convert("RGB")
    buffer = io.BytesIO()
    image.quantize(TINTS, dither=Image.Dither.NONE).save(buffer, format="png", optimize=True)
    return buffer.getvalue()


def _two_curves(picture: Picture) -> Any:
    canvas, (top, low) = panels(2, 1, WIDTH, ROW, sharex=True, height_ratios=[1.8, 1.0])
    entries = []
    zero_line(low)
    for i, (name, pair) in enumerate(picture.lines.items()):
        few = pair.x.size <= FEW
        mine = {"color": colour(i), "linestyle": dashes(i + 1), "linewidth": 1.4}
        x = picture.x.shown(pair.x)
        top.plot(x, picture.y.shown(pair.other), **(POINTS if few else OTHER))
        top.plot(x, picture.y.shown(pair.ours), **mine)
        beneath = mine | {"linewidth": 1.0} | ({"marker": "o", "markersize": 3} if few else {})
        if len(picture.lines) == 1:
            beneath["linestyle"] = "-"
        low.plot(x, (pair.ours - pair.other) * picture.y.factor, **beneath)
        entries.append(line(f"pyrofit, {name}" if name else "pyrofit", **mine))
    entries.append(line(picture.other, **(POINTS if few else OTHER)))
    top.set_ylabel(picture.y.label)
    low.set_ylabel(f"difference\n[{_difference_unit(picture)}]")
    low.set_xlabel(picture.x.label)
    low.ticklabel_format(axis="y", style="sci", scilimits=(-3, 3))
    for ax in (top, low):
        ax.margins(y=0.08)
    legend_below(canvas, entries)
    canvas.align_ylabels()
    return canvas


def _difference_unit(picture: Picture) -> str:
    return "K" if picture.y.unit == "°C" else picture.y.unit


def _errors(picture: Picture) -> Any:
    canvas, (ax,) = panels(1, 1, WIDTH, SINGLE)
    entries = []
    for i, (name, pair) in enumerate(picture.lines.items()):
        look = {"color": colour(i), "linestyle": dashes(i), "marker": MARKERS[i], "markersize": 4}
        h, error = picture.x.shown(pair.x), picture.y.shown(pair.ours)
        ax.loglog(h, error, **look)
        _slope(ax, h, error, picture.order or 0.0)
        entries.append(line(name, **look))
    entries.append(line(f"slope {picture.order:.2g}", color="0.5", linewidth=0.8))
    ax.set_xlabel(picture.x.label)
    ax.set_ylabel(picture.y.label)
    ax.margins(0.08)
    ax.set_xticks(sorted({*h}), [f"{size:.3g}" for size in sorted({*h})])
    ax.xaxis.set_minor_locator(NullLocator())
    legend_below(canvas, entries)
    return canvas


def _slope(ax: Axes, h: Curve, error: Curve, order: float) -> None:
    """A line of the expected slope through the geometric middle of the points."""
    middle = np.exp(np.mean(np.log(error)) - order * np.mean(np.log(h)))
    ends = np.array([h.min(), h.max()])
    ax.plot(ends, middle * ends**order, color="0.5", linewidth=0.8, zorder=1)
