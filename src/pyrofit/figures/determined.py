"""What the data determine: sensitivities, correlation and profiles of the parameters."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import MaxNLocator

from pyrofit.config import Study
from pyrofit.figures import style
from pyrofit.results.files import Results, read_csv
from pyrofit.tables.describe import title_of
from pyrofit.tables.determined import WITHIN, estimates, matrix_of, noise

_UNITS: dict[str, tuple[str, str, float]] = {
    "mlr": ("mass loss rate", "g/(m² s)", 1e3),
    "back_temperature": ("back temperature", "K", 1.0),
}
_PARABOLA: dict[str, Any] = {"color": "0.45", "linestyle": (0, (4, 2)), "linewidth": 1.0}
_PROFILE: dict[str, Any] = {"color": style.COLOURS[0], "marker": "o", "markersize": 2.4}
_LEVEL: dict[str, Any] = {"color": "black", "linewidth": 0.7}
_NOISE_LEVEL: dict[str, Any] = {"color": "black", "linewidth": 0.9, "linestyle": (0, (1, 1.5))}
_LIMIT: dict[str, Any] = {"color": style.COLOURS[1], "linewidth": 1.6}


def sensitivities(study: Study, results: Results) -> Canvas:
    """Draw d curve / d parameter times the distance of its limits against time, by channel."""
    words = dict.fromkeys(("experiment", "signal", "parameter"), object)
    columns = {**words, **dict.fromkeys(("time_s", "si"), float)}
    frame = read_csv(results.identification("sensitivities.csv"), columns)
    channels = noise(results)["channels"]
    canvas, axes = style.panels(len(channels), 2, style.TWO_COLUMNS, 72.0)
    style.letter(axes, [title_of(study, c["experiment"]) for c in channels])
    looks = {
        name: {"color": style.colour(i), "linestyle": style.dashes(i + i // len(style.COLOURS))}
        for i, name in enumerate(study.imp.estimate)
    }
    for ax, channel in zip(axes, channels, strict=True):
        label, unit, factor = _UNITS[channel["signal"]]
        here = frame[
            (frame["experiment"] == channel["experiment"]) & (frame["signal"] == channel["signal"])
        ]
        sd = factor * channel["sd_median"]
        ax.axhspan(-sd, sd, color=style.BAND, linewidth=0.0)
        for name, look in looks.items():
            curve = here[here["parameter"] == name]
            ax.plot(curve["time_s"], factor * curve["si"], **look)
        style.zero_line(ax)
        ax.set_xlabel("time [s]")
        ax.set_ylabel(f"change of {label}\nper limits' distance [{unit}]")
    style.legend_below(
        canvas,
        [
            *(style.line(name, **look) for name, look in looks.items()),
            style.patch("± sd of the noise", color=style.BAND),
        ],
    )
    return canvas


def correlation(study: Study, results: Results) -> Canvas:
    """Draw the correlation matrix of the estimates, with its numbers."""
    return draw_matrix(matrix_of(study, results), "correlation [–]")


def draw_matrix(matrix: pd.DataFrame, label: str) -> Canvas:
    """Draw a matrix of correlations, with its numbers."""
    names = [str(name) for name in matrix]
    size = min(style.TWO_COLUMNS, 34.0 + 11.5 * len(names))
    canvas, (ax,) = style.panels(1, 1, size + 12.0, size - 8.0)
    # Blue and red are told apart by every kind of colour vision.
    image = ax.imshow(matrix.to_numpy(), cmap="RdBu_r", vmin=-1.0, vmax=1.0)
    for i, row in enumerate(matrix.to_numpy()):
        for k, value in enumerate(row):
            text = f"{round(value, 2) + 0.0:.2f}".replace("-", "−")
            colour = "white" if abs(value) > 0.65 else "black"
            ax.text(k, i, text, ha="center", va="center", color=colour, fontsize=7)
    ax.set_xticks(range(len(names)), names, rotation=45, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(names)), names)
    ax.tick_params(length=0)
    canvas.colorbar(image, ax=ax, label=label, shrink=0.85)
    return canvas


def profiles(study: Study, results: Results) -> Canvas:
    """Draw the rise of chi-square against each parameter: parabola, profile, and 95 % levels."""
    found = estimates(study, results)
    inflation = float(noise(results)["inflation"])
    curves = read_csv(results.identification("profiles.csv"))
    canvas, axes = style.panels(len(found), 3, style.TWO_COLUMNS, 50.0)
    style.letter(axes, list(found.index))
    for i, (ax, name) in enumerate(zip(axes, found.index, strict=True)):
        curve = curves[curves["parameter"] == name]
        _draw_profile(ax, study, found.loc[name], curve, inflation)
        if i % 3 == 0:
            ax.set_ylabel("rise of χ² [–]")
    style.legend_below(canvas, _entries(inflation))
    return canvas


def _draw_profile(
    ax: Axes, study: Study, row: pd.Series, curve: pd.DataFrame, inflation: float
) -> None:
    parameter = study.parameters[str(row["parameter"])]
    lower, upper = (bound / parameter.factor for bound in parameter.bounds_si)
    factor = parameter.factor
    top = (WITHIN * inflation) ** 2
    low, high, at, sd = (float(row[c]) / factor for c in ("low", "high", "estimate", "sd"))
    margin = 0.25 * (high - low)
    x = np.linspace(max(lower, low - margin), min(upper, high + margin), 200)
    if not row["bound"]:  # at a limit chi-square has a slope, and no parabola
        ax.plot(x, ((x - at) / sd * inflation) ** 2, **_PARABOLA)
    if len(curve):
        # Between the points the root of the rise is a straight line, at a limit the rise itself.
        power = 1.0 if row["bound"] else 2.0
        points = curve["value"].to_numpy(float) / factor
        root = np.maximum(curve["rise"].to_numpy(float), 0.0) ** (1.0 / power)
        fine = np.linspace(points[0], points[-1], 300)
        ax.plot(fine, np.interp(fine, points, root) ** power, color=_PROFILE["color"])
        ax.plot(points, root**power, **{**_PROFILE, "linestyle": "none"})
    ax.axhline(top, **_LEVEL)
    if inflation > 1.0:
        ax.axhline(WITHIN**2, **_NOISE_LEVEL)
    ax.set_xlim(x[0], x[-1])
    ax.set_ylim(0.0, 1.6 * top)
    for bound in (lower, upper):
        if x[0] <= bound <= x[-1]:
            ax.axvline(bound, **_LIMIT, clip_on=False)
    ax.xaxis.set_major_locator(MaxNLocator(4))
    ax.set_xlabel(f"{row['parameter']} [{parameter.unit}]")


def _entries(inflation: float) -> list[Any]:
    size = f"3.84 × {inflation**2:.3g}" if inflation > 1.0 else "3.84"
    entries = [
        style.line("profile", **_PROFILE),
        style.line("parabola", **_PARABOLA),
        style.line(f"95 %: {size}", **_LEVEL),
        style.line("limit", **_LIMIT),
    ]
    if inflation > 1.0:
        entries.insert(3, style.line("noise alone: 3.84", **_NOISE_LEVEL))
    return entries
