"""The tables that compare cost functions and optimisers."""

from pyrofit.estimate.family import GOOD, MOST
from pyrofit.tables.comparison import bands, every_cost
from pyrofit.tables.differences import cost_tests
from pyrofit.tables.table import Table

COMPARED_TABLES: dict[str, Table] = {
    "every_cost": Table(
        applies=lambda study: True,
        make=every_cost,
        title="Every best set under every cost, and on one metric",
        note="'Fitted': every cost as the searches minimised it. At an experiment that no cost was "
        "fitted to, the cost functions are those of the study with this experiment in the place of "
        "theirs, over its whole record. The metric, over all measured points: CV(RMSE) of the mass "
        "loss rate [–], RMSE of the back temperature [K].",
        headings={"fitted_with": "fitted with", "found_by": "found by"},
        group_by="place",
    ),
    "cost_tests": Table(
        applies=lambda study: len(study.imp.costs) > 1,
        make=cost_tests,
        title="Do the cost functions differ?",
        note="Over the repetitions of SCE-UA. Place: Kruskal and Wallis's test; scatter: Brown and "
        "Forsythe's; both p are Holm-corrected for the number of quantities, and 0.05 is the "
        "level. Effect: epsilon squared, the share of the ranks' variance, from 0 to 1. Pairs, "
        "where places differ: by Mann and Whitney's test, Holm-corrected, with Cliff's delta: +1, "
        "all values of the first are above those of the second. Scatter ratio: largest over "
        "smallest mean distance from the median. A difference may be significant and yet small: it "
        "is given in per cent of the limits' distance and of the width of the 95 % interval that "
        "the data leave.",
        headings={
            "difference": "largest difference of medians",
            "of_limits": "in % of limits",
            "of_interval": "in % of the 95 % interval",
            "p_place": "p, place",
            "effect": "effect",
            "pairs": "pairs that differ",
            "scatter_ratio": "scatter ratio",
            "p_scatter": "p, scatter",
        },
        group_by="kind",
    ),
    "bands": Table(
        applies=lambda study: True,
        make=bands,
        title="What the good sets predict",
        note=f"Good sets: those whose cost is at most {GOOD:g} of the lowest known one, met on a "
        f"random walk from there within the limits; simulated are at most {MOST} for each cost "
        "function, those that lie farthest apart. Width: highest minus lowest "
        "prediction, mean over time. Within: share of the measured points inside the band, and "
        "inside the band widened by their stated uncertainty. The band is the reach of the good "
        "sets, not an interval of a probability.",
        headings={
            "cost_function": "cost function",
            "good_sets": "good sets",
            "width_percent": "width [% of mean]",
            "width_K": "width [K]",
            "within_percent": "points within [%]",
            "within_with_uncertainty_percent": "with their uncertainty [%]",
        },
        group_by="experiment",
    ),
}
