"""Profiles of the likelihood."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.constants import QUANTILE
from pyrofit.results.files import Results, read_csv
from pyrofit.results.identification import estimates, read_noise
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.facts import Facts
from pyrofit.show.figure import Figure
from pyrofit.show.text import listed, typeset

_PARABOLA: DrawStyle = {"color": "0.45", "linestyle": (0, (4, 2)), "linewidth": 1.0}


_PROFILE: DrawStyle = {"color": style.COLOURS[0], "marker": "o", "markersize": 2.4}


_LEVEL: DrawStyle = {"color": "black", "linewidth": 0.7}


_NOISE_LEVEL: DrawStyle = {"color": "black", "linewidth": 0.9, "linestyle": (0, (1, 1.5))}


_LIMIT: DrawStyle = {"color": style.COLOURS[1], "linewidth": 1.6}


def draw_profiles_of_parameters(study: Study, results: Results) -> Canvas:
    """Draw the rise of chi-square against each parameter: parabola, profile, and 95 % levels."""
    found = estimates(study, results)
    dispersion = read_noise(results).dispersion
    curves = read_csv(results.identification("profiles.csv"))
    found = found[[_has_curve(row, curves) for _, row in found.iterrows()]]
    canvas, axes = style.panels(max(len(found), 1), 3, style.TWO_COLUMNS, 50.0)
    if found.empty:
        axes[0].set_axis_off()
        axes[0].text(0.5, 0.5, "all parameters are at limits", ha="center", va="center")
        return canvas
    style.letter(axes, list(found.index))
    for i, (ax, name) in enumerate(zip(axes, found.index, strict=True)):
        curve = curves[curves["parameter"] == name]
        _draw_profile(ax, study, found.loc[name], curve, dispersion)
        if i % 3 == 0:
            ax.set_ylabel("rise of χ² [–]")
    style.legend_below(canvas, _entries(dispersion))
    return canvas


def _has_curve(row: pd.Series, curves: pd.DataFrame) -> bool:
    """Tell whether there is anything to draw: at a limit there is no parabola."""
    return not row["bound"] or bool((curves["parameter"] == row["parameter"]).any())


def _draw_profile(
    ax: Axes, study: Study, row: pd.Series, curve: pd.DataFrame, dispersion: float
) -> None:
    from matplotlib.ticker import MaxNLocator

    parameter = study.parameters[str(row["parameter"])]
    lower, upper = (bound / parameter.factor for bound in parameter.bounds_si)
    factor = parameter.factor
    top = QUANTILE**2 * dispersion
    low, high, at, sd = (float(row[c]) / factor for c in ("low", "high", "estimate", "sd"))
    margin = 0.25 * (high - low)
    x = np.linspace(max(lower, low - margin), min(upper, high + margin), 200)
    if not row["bound"]:  # at a limit chi-square has a slope, and no parabola
        ax.plot(x, ((x - at) / sd) ** 2 * dispersion, **_PARABOLA)
    if len(curve):
        # Between the points the root of the rise is a straight line, at a limit the rise itself.
        straight = bool(row["bound"])
        points = curve["value"].to_numpy(float) / factor
        root = np.maximum(curve["rise"].to_numpy(float), 0.0)
        root = root if straight else np.sqrt(root)
        fine = np.linspace(points[0], points[-1], 300)
        drawn = np.interp(fine, points, root)
        ax.plot(fine, drawn if straight else drawn**2, color=_PROFILE["color"])
        unjoined: DrawStyle = {**_PROFILE, "linestyle": "none"}
        ax.plot(points, root if straight else root**2, **unjoined)
    ax.axhline(top, **_LEVEL)
    if dispersion > 1.0:
        ax.axhline(QUANTILE**2, **_NOISE_LEVEL)
    ax.set_xlim(x[0], x[-1])
    ax.set_ylim(0.0, 1.6 * top)
    for bound in (lower, upper):
        if x[0] <= bound <= x[-1]:
            ax.axvline(bound, **_LIMIT, clip_on=False)
    ax.xaxis.set_major_locator(MaxNLocator(4))
    ax.set_xlabel(typeset(f"{row['parameter']} [{parameter.unit}]"))


def _entries(dispersion: float) -> list[Any]:
    size = f"3.84 × {dispersion:.3g}" if dispersion > 1.0 else "3.84"
    entries = [
        style.line("profile", **_PROFILE),
        style.line("parabola", **_PARABOLA),
        style.line(f"95 %: {size}", **_LEVEL),
        style.line("limit", **_LIMIT),
    ]
    if dispersion > 1.0:
        entries.insert(3, style.line("noise alone: 3.84", **_NOISE_LEVEL))
    return entries


def verdict_on_profiles(study: Study, facts: Facts) -> str:
    """Say which intervals are those of profiles."""
    ours = [e for e in facts.estimates if e.stage == "imp"]
    at_limits = [e.name for e in ours if e.bound and e.method != "profile"]
    left = f" Not drawn, as they are at limits: {listed(at_limits)}." if at_limits else ""
    if not facts.goodness["imp"].describes:
        return "The model misses its tests: all intervals are linear and include the misfit." + left
    bent = [e.name for e in ours if e.method == "profile"]
    if not bent:
        return "All intervals are linear: chi-square follows its parabola." + left
    return f"Intervals by profile: {listed(bent)}. Linear ones: {len(ours) - len(bent)}.{left}"


FIGURE = Figure(
    place=20,
    make=draw_profiles_of_parameters,
    verdict=verdict_on_profiles,
    title="Profiles of the likelihood",
    caption="Rise of χ² over its least value against each parameter. Where it follows its "
    "parabola to the 95 % level, the linear interval is quoted; else the profile, all other "
    "parameters fitted anew at each point. Where a profile meets a limit (vertical line) below "
    "the level, the limit cuts the interval off.",
)
