"""Experiments that would separate competing models."""

from typing import Any

import numpy as np
import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.diagnosis.effects import LIMIT
from pyrofit.show.diagnosis.words import MOST
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.table import Table


def next_experiments_table(study: Study, results: Results) -> pd.DataFrame:
    """List the experiments that would separate competing models best."""
    found = diagnosis.read(study, results).next_experiment
    rows = [{"experiment": d.words, "separation_sd": d.separation_sd} for d in found]
    frame = pd.DataFrame(rows, columns=["experiment", "separation_sd"])
    return frame.sort_values(
        "separation_sd", ascending=False, kind="stable", ignore_index=True
    ).head(MOST)


MOST_DESIGNS = 12


def draw_next_experiments(study: Study, results: Results) -> Canvas:
    """Draw how well each planned experiment would separate models that are not distinguished."""
    found = diagnosis.read(study, results)
    shown = sorted(found.next_experiment, key=lambda d: -d.separation_sd)[:MOST_DESIGNS]
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 24.0 + 5.5 * len(shown))
    longest = 0.0
    several = any(len(design.pairs) > 1 for design in shown)
    for i, design in enumerate(shown):
        ax.barh(i, design.separation_sd, height=0.62, color=style.COLOURS[0])
        sizes = list(design.pairs.values())
        if several:
            ax.plot(sizes, [i] * len(sizes), "o", color="black", markersize=3, clip_on=False)
        longest = max([longest, design.separation_sd, *sizes])
    ax.axvline(np.sqrt(found.ambiguity), **LIMIT)
    ax.set_yticks(range(len(shown)), [d.words for d in shown], fontsize=6.5)
    ax.set_ylim(len(shown) - 0.5, -0.5)
    ax.set_xlim(0.0, 1.06 * max(4.0, longest))
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("separation [standard deviations]")
    entries: list[Any] = [
        style.patch(
            "the two models separated least" if several else "the two models",
            color=style.COLOURS[0],
        ),
        style.line("distinguished (3 sd)", **LIMIT),
    ]
    if several:
        look = {"marker": "o", "color": "black", "markersize": 3, "linestyle": "none"}
        entries.append(style.line("every pair", **look))
    style.legend_below(canvas, entries)
    return canvas


TABLE = Table(
    place=800,
    make=next_experiments_table,
    title="Next experiments",
    note="Separation of the two models that the experiment separates least, in standard "
    "deviations, with the uncertainty of their parameters. Above 3 it distinguishes "
    "them.",
    headings={"separation_sd": "separation [sd]"},
)


FIGURE = Figure(
    place=850,
    applies=lambda found: bool(found.next_experiment),
    make=draw_next_experiments,
    title="Next experiments",
    caption="Standard deviations by which planned experiments would separate the models that "
    "the data cannot distinguish, or else the two best ones. Bars: the pair that is "
    "separated least; points: each pair.",
)
