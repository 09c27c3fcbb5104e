"""How often each effect is found in disturbed data."""

import textwrap

import numpy as np

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.steps.stability.facts import read

MOST = 16
"""Effects that the figure shows; the table has all."""
WRAP = 44
"""Letters of a line beside the bars."""


def draw_shares(study: Study, results: Results) -> Canvas:
    """Draw the shares of the draws whose verdict names an effect, or whose model has it."""
    found = read(study, results)
    shown = found.effects[:MOST]
    count = len(found.draws)
    claimed = np.array([100.0 * found.times_claimed(e) / count for e in shown])
    final = np.array([100.0 * found.times_final(e) / count for e in shown])
    canvas, (ax,) = style.panels(1, 1, style.TWO_COLUMNS, 28.0 + 7.0 * max(len(shown), 1))
    at = np.arange(len(shown), dtype=float)
    ax.barh(at, final, height=0.62, color=style.COLOURS[5])
    ax.barh(at, claimed, height=0.34, color=style.COLOURS[0])
    labels = [textwrap.fill(effect_name(effect), WRAP) for effect in shown]
    ax.set_yticks(at, labels, fontsize=6.5)
    for label, effect in zip(ax.get_yticklabels(), shown, strict=True):
        if effect in found.claimed:
            label.set_fontweight("bold")
    ax.set_ylim(max(len(shown), 1) - 0.5, -0.5)
    if not shown:
        ax.text(50.0, 0.0, "no effect is found in any data set", ha="center", va="center")
    ax.set_xlim(0.0, 100.0)
    ax.set_xlabel(f"share of {count} disturbed data sets [%]")
    entries = [
        style.patch("verdict claims it", color=style.COLOURS[0]),
        style.patch("the model of the search has it", color=style.COLOURS[5]),
    ]
    style.legend_below(canvas, entries)
    return canvas


FIGURES = {
    "stability": Figure(
        place=10,
        make=draw_shares,
        title="How often disturbed data lead to each effect",
        caption="Share of the disturbed data sets whose verdict claims an effect (dark), and whose "
        "search ends with a model that has it (light). The tests of a claim may reject it "
        f"afterwards. Bold: claimed from the measured data. The figure shows {MOST} effects at "
        "most, the table all.",
    ),
}
