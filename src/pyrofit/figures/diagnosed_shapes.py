"""Curves of the diagnosis beside those of the signals: profiles of strengths, and probes."""

import textwrap
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Canvas
from matplotlib.ticker import MaxNLocator

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.figures import style
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.tables.diagnosis import shown_unit

_LEVEL: dict[str, Any] = {"color": "black", "linewidth": 0.8, "linestyle": (0, (4, 2))}
_ABSENT: dict[str, Any] = {"color": "0.3", "linewidth": 0.8, "linestyle": (0, (1, 1.5))}
_PROFILE: dict[str, Any] = {"color": style.COLOURS[0], "marker": "o", "markersize": 3}


def profiles(study: Study, results: Results) -> Canvas:
    """Draw the rise of chi-square with the strength of each effect of the verdict's model."""
    found = diagnosis.read(study, results)["profiles"]
    canvas, axes = style.panels(len(found), 3, style.TWO_COLUMNS, 58.0)
    catalogue = known_effects()
    style.letter(axes, [catalogue[profile["effect"]].title for profile in found])
    absent: list[Any] = []
    for ax, profile in zip(axes, found, strict=True):
        quantity = catalogue[profile["effect"]].quantities[profile["parameter"]]
        strength, rise = np.array(profile["value"]), np.array(profile["rise"])
        # Between the points the root of the rise is a straight line.
        fine = np.linspace(strength[0], strength[-1], 300)
        root = np.sqrt(np.maximum(rise, 0.0))
        ax.plot(fine, np.interp(fine, strength, root) ** 2, color=_PROFILE["color"])
        ax.plot(strength, rise, **_PROFILE, linestyle="none")
        ax.axhline(float(profile["level"]), **_LEVEL)
        low, high = ax.get_xlim()
        if low <= quantity.value <= high:
            ax.axvline(quantity.value, **_ABSENT)
            absent = [style.line("effect absent", **_ABSENT)]
        ax.set_ylim(min(0.0, rise.min()), 1.6 * float(profile["level"]))
        ax.xaxis.set_major_locator(MaxNLocator(4))
        ax.ticklabel_format(axis="x", scilimits=(-3, 4))
        ax.set_xlabel(f"{quantity.symbol} [{quantity.unit.replace('-', '–')}]")
    axes[0].set_ylabel("rise of χ² [–]")
    entries = [style.line("fitted anew", **_PROFILE), style.line("95 %", **_LEVEL)]
    style.legend_below(canvas, [*entries, *absent])
    return canvas


def probes(study: Study, results: Results) -> Canvas:
    """Draw the free corrections that were put into the model."""
    found = diagnosis.read(study, results)["probes"]
    canvas, axes = style.panels(len(found), 2, style.TWO_COLUMNS, 55.0)
    titles = [f"{p['what']}: absorbs {100.0 * p['absorbed']:.0f} %" for p in found]
    style.letter(axes, [textwrap.fill(title, 44) for title in titles])
    for ax, probe in zip(axes, found, strict=True):
        x, y = np.array(probe["shape"], dtype=float).reshape(-1, 2).T
        unit, factor = shown_unit(probe["unit"])
        # Without a unit it is a factor, else a change.
        ax.axhline(1.0 if probe["unit"] == "-" else 0.0, color="0.3", linewidth=0.5)
        ax.plot(x, factor * y, color=style.COLOURS[0])
        ax.set_xlabel("time [s]" if probe["probe"] == "flux" else "temperature [K]")
        what = "factor on the" if probe["unit"] == "-" else "change of the"
        ax.set_ylabel(f"{what} {probe['probe'].replace('_', ' ')}\n[{unit}]")
    return canvas
