"""How the costs agree in ranking the stored sets, and where their valleys lie."""

import numpy as np

from pyrofit.analysis.rescoring import GOOD, VALLEY
from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show import style
from pyrofit.show.drawn import Canvas
from pyrofit.show.figure import Figure
from pyrofit.show.matrix import draw_matrix
from pyrofit.steps.rescore import record
from pyrofit.steps.rescore.facts import correlation_of_shown, of_shown, shown_by_rank


def draw_agreement(study: Study, results: Results) -> Canvas:
    """Draw the rank correlation of the costs."""
    return draw_matrix(correlation_of_shown(study, results), "rank correlation [–]")


def agreement_best(study: Study, results: Results) -> Canvas:
    """Draw the rank correlation of the costs over the best sets of each."""
    table = of_shown(record.read(study, results), record.matrix(results, record.AMONG_BEST))
    return draw_matrix(table, "rank correlation [–]")


def regret(study: Study, results: Results) -> Canvas:
    """Draw which share of the sets each cost finds better than the best set of another."""
    table = of_shown(record.read(study, results), record.matrix(results, record.BETTER))
    percent = 100.0 * table.to_numpy()
    names = [str(name) for name in table]
    size = min(style.TWO_COLUMNS, 34.0 + 11.5 * len(names))
    canvas, (ax,) = style.panels(1, 1, size + 12.0, size - 8.0)
    image = ax.imshow(percent, cmap="cividis_r", vmin=0.0, vmax=100.0)
    for (i, k), value in np.ndenumerate(percent):
        colour = "white" if value > 55.0 else "black"
        text = f"{value:.2g}" if value < 10.0 else f"{value:.0f}"
        ax.text(k, i, text, ha="center", va="center", color=colour, fontsize=7)
    ax.set_xticks(range(len(names)), names, rotation=45, ha="right", rotation_mode="anchor")
    ax.set_yticks(range(len(names)), names)
    ax.tick_params(length=0)
    canvas.colorbar(image, ax=ax, label="sets that are better [%]", shrink=0.85)
    return canvas


def draw_valleys(study: Study, results: Results) -> Canvas:
    """Draw the range of each parameter over the best sets of every cost."""
    measures = shown_by_rank(record.read(study, results))
    names = list(study.imp.estimate)
    height = 14.0 + 4.2 * len(measures)
    canvas, axes = style.panels(len(names), 3, style.TWO_COLUMNS, height, sharey=True)
    places = np.arange(len(measures))[::-1]
    for ax, name in zip(axes, names, strict=True):
        for y, measure in zip(places, measures, strict=True):
            at = measure.valley[name]
            ax.plot([at.low, at.high], [y, y], color=style.COLOURS[0], linewidth=3.5, alpha=0.55)
            ax.plot(at.best, y, color="black", marker="|", markersize=6.0)
        ax.set_xlim(-0.02, 1.02)
        ax.set_yticks(places, [measure.name for measure in measures])
        ax.tick_params(axis="y", length=0)
    style.letter(axes, names)
    canvas.supxlabel("fraction of the search range [–]", fontsize=8)
    return canvas


FIGURES = {
    "agreement": Figure(
        place=10,
        make=draw_agreement,
        title="How the costs agree in ranking the stored sets",
        caption="Spearman's rank correlation over the stored sets: 1 (dark red) means the same "
        "order, 0 (white) no relation, −1 (dark blue) the reverse order. Costs that rank all sets "
        "in the same order as one shown are left out.",
    ),
    "agreement_best": Figure(
        place=15,
        make=agreement_best,
        title=f"How the costs agree in ranking the best {100.0 * GOOD:g} % of the sets",
        caption=f"Rank correlation of two costs over the best {100.0 * GOOD:g} % of the sets of "
        "the cost in the row. Over all sets, most costs agree on which are bad. Here they have to "
        "agree on the order of the good ones. The value is also 0 where a cost ranks them equal.",
    ),
    "regret": Figure(
        place=20,
        make=regret,
        title="The stored set with the lowest value of one cost, under another cost",
        caption="Share of the stored sets that the cost of the column finds better than the "
        "set with the lowest cost of the row. 0 means that both costs choose the same set.",
        shown=False,
    ),
    "valleys": Figure(
        place=30,
        make=draw_valleys,
        title="Where the valleys of the costs lie",
        caption=f"Bars: range of each parameter over the best {100.0 * VALLEY:g} % of the stored "
        "sets of a cost. Marks: the set with its lowest value. With a long bar, the cost does not "
        "determine the parameter. Where bars lie apart, two costs ask for different values.",
    ),
}
