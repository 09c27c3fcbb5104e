"""Profiles of the strengths."""

from typing import Any

import numpy as np

from pyrofit.config import Study
from pyrofit.effects import known_effects
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas, DrawStyle
from pyrofit.show.figure import Figure

_LEVEL: DrawStyle = {"color": "black", "linewidth": 0.8, "linestyle": (0, (4, 2))}


_ABSENT: DrawStyle = {"color": "0.3", "linewidth": 0.8, "linestyle": (0, (1, 1.5))}


_PROFILE: DrawStyle = {"color": style.COLOURS[0], "marker": "o", "markersize": 3}


def draw_profiles(study: Study, results: Results) -> Canvas:
    """Draw the rise of chi-square with the strength of each effect of the verdict's model."""
    from matplotlib.ticker import MaxNLocator

    found = diagnosis.read(study, results).profiles
    canvas, axes = style.panels(len(found), 3, style.TWO_COLUMNS, 58.0)
    catalogue = known_effects()
    style.letter(axes, [catalogue[profile.effect].title for profile in found])
    absent: list[Any] = []
    for ax, profile in zip(axes, found, strict=True):
        quantity = catalogue[profile.effect].quantities[profile.parameter]
        strength, rise = np.array(profile.value), np.array(profile.rise)
        # Between the points the root of the rise is a straight line.
        fine = np.linspace(strength[0], strength[-1], 300)
        root = np.sqrt(np.maximum(rise, 0.0))
        ax.plot(fine, np.interp(fine, strength, root) ** 2, color=_PROFILE["color"])
        ax.plot(strength, rise, **_PROFILE, linestyle="none")
        ax.axhline(profile.level, **_LEVEL)
        low, high = ax.get_xlim()
        if low <= quantity.value <= high:
            ax.axvline(quantity.value, **_ABSENT)
            absent = [style.line("effect absent", **_ABSENT)]
        ax.set_ylim(min(0.0, rise.min()), 1.6 * profile.level)
        ax.xaxis.set_major_locator(MaxNLocator(4))
        ax.ticklabel_format(axis="x", scilimits=(-3, 4))
        ax.set_xlabel(f"{quantity.symbol} [{quantity.unit.replace('-', '–')}]")
    axes[0].set_ylabel("rise of χ² [–]")
    entries = [style.line("all else refitted", **_PROFILE), style.line("95 %", **_LEVEL)]
    style.legend_below(canvas, [*entries, *absent])
    return canvas


FIGURE = Figure(
    place=250,
    applies=lambda found: bool(found.profiles),
    make=draw_profiles,
    title="Profile likelihood of the strengths",
    caption="Rise of chi-square with the strength of each effect found, all else refitted "
    "at every point. The 95 % interval lies below the dashed line, at 3.84 times chi-square "
    "per degree of freedom. Below zero: the refit found a lower chi-square than the fit.",
)
