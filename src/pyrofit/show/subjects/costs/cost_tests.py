"""Whether the cost functions differ, as a table."""

from pyrofit.analysis.cost_tests import cost_tests
from pyrofit.show.table import Table

TABLE = Table(
    place=40,
    applies=lambda study: len(study.imp.costs) > 1,
    make=cost_tests,
    title="Do the cost functions differ?",
    note="Over the repetitions of SCE-UA. Place: Kruskal and Wallis's test; scatter: Brown "
    "and Forsythe's; both p are Holm-corrected for the number of quantities, and 0.05 "
    "is the level. Effect: epsilon squared, the share of the ranks' variance, from 0 "
    "to 1. Pairs, where places differ: by Mann and Whitney's test, Holm-corrected, "
    "with Cliff's delta: +1, all values of the first are above those of the second. "
    "Scatter ratio: largest over smallest mean distance from the median. A "
    "significant difference may be small. It is given in per cent of the search "
    "range and of the width of the 95 % interval.",
    headings={
        "difference": "largest difference of medians",
        "of_limits": "in % of search range",
        "of_interval": "in % of the 95 % interval",
        "p_place": "p, place",
        "effect": "effect",
        "pairs": "pairs that differ",
        "scatter_ratio": "scatter ratio",
        "p_scatter": "p, scatter",
    },
    group_by="kind",
)
