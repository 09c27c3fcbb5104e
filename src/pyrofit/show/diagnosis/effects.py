"""How well each effect would show, and which look alike."""

from collections.abc import Sequence

import numpy as np

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.diagnosis_schema import OfScreen
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Axes, Canvas, DrawStyle
from pyrofit.show.figure import Figure

FAMILIES = {"apparatus": "xxxx", "environment": "////", "material": ""}
"""Hatching of each family, so that they stay apart in grey."""


LIMIT: DrawStyle = {"color": "black", "linewidth": 0.8, "linestyle": (0, (4, 2))}


def draw_effects(study: Study, results: Results) -> Canvas:
    """Draw how well each effect would show, and which look alike."""
    found = diagnosis.read(study, results)
    names = list(found.confusability.effects)
    screen = {s.effect: s for s in found.screen}
    order = sorted(range(len(names)), key=lambda i: (_family(screen[names[i]]), names[i]))
    names = [names[i] for i in order]
    cosine = np.asarray(found.confusability.cosine, dtype=float)[np.ix_(order, order)]
    canvas, (bars, image) = style.panels(
        2, 2, style.TWO_COLUMNS, max(75.0, 34.0 + 3.5 * len(names)), width_ratios=[1.0, 1.55]
    )
    style.letter([bars, image], ["detectability", "confusability"])
    _bars(bars, [screen[name] for name in names], found.base.score_critical)
    # Both signs of a cosine mean alike: a strength of the other sign.
    drawn = image.imshow(np.abs(cosine), cmap="Greys", vmin=0.0, vmax=1.0, aspect="auto")
    for i, k in zip(*np.nonzero(np.abs(cosine) >= 0.9), strict=True):
        if i != k:
            image.text(k, i, "×", ha="center", va="center", color="white", fontsize=7)
    image.set_xticks(range(len(names)), names, rotation=90, fontsize=6)
    image.set_yticks(range(len(names)), [])
    image.tick_params(length=0)
    canvas.colorbar(drawn, ax=image, label="|cosine| [–]", shrink=0.7)
    entries = [
        style.patch(family, facecolor=style.colour(i), hatch=hatch, edgecolor="white")
        for i, (family, hatch) in enumerate(FAMILIES.items())
    ]
    score = style.line(
        "score z of the residuals", marker="D", markersize=3, color="black", linestyle="none"
    )
    level = style.line("critical value of z", **LIMIT)
    style.legend_below(canvas, [*entries, score, level])
    return canvas


def _family(row: OfScreen) -> int:
    return list(FAMILIES).index(row.family) if row.family in FAMILIES else len(FAMILIES)


def _bars(ax: Axes, rows: Sequence[OfScreen], critical: float) -> None:
    """Draw detectability, and the score that was found."""
    sizes = [row.detectability for row in rows]
    scores = [row.z for row in rows]
    for i, (row, size) in enumerate(zip(rows, sizes, strict=True)):
        family = _family(row)
        hatch = [*FAMILIES.values(), ""][family]
        look: DrawStyle = {"color": style.colour(family), "hatch": hatch, "edgecolor": "white"}
        ax.barh(i, size, height=0.75, **look, linewidth=0.0)
    ax.plot(scores, range(len(rows)), "D", color="white", markersize=4.6)
    ax.plot(scores, range(len(rows)), "D", color="black", markersize=3)
    ax.axvline(critical, **LIMIT)
    ax.set_xscale("log")
    ax.set_xlim(0.3, 2.0 * max([*sizes, *scores, 10.0]))
    ax.set_yticks(range(len(rows)), [row.effect for row in rows], fontsize=6)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("standard deviations [–]")


FIGURE = Figure(
    place=750,
    applies=lambda found: bool(found.screen) and bool(found.confusability.effects),
    make=draw_effects,
    title="Detectability and confusability of the effects",
    caption="a) Bars: standard deviations by which each effect of typical strength would "
    "change the measurements, after a refit of all parameters. These measurements "
    "cannot show effects with short bars. Diamonds: the same for the residuals of the "
    "base model in the direction of the effect. b) Cosine between the changes of two "
    "effects after such a refit. Dark pairs look alike; crosses mark 0.9 and more.",
)
