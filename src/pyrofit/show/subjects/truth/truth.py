"""Truth beside estimate."""

from pyrofit.analysis.recovery import fits_to_computed, truth
from pyrofit.show.subjects.truth.sentences import FOUND_BY
from pyrofit.show.table import Table

_HEADINGS = {
    f"{key}_{column}": f"{words} {text}"
    for key, words in FOUND_BY.items()
    for column, text in {
        "best": "best",
        "error_truth_percent": "error [% of truth]",
        "error_limits_percent": "error [% of search range]",
    }.items()
}

TABLE = Table(
    place=10,
    applies=lambda study: bool(fits_to_computed(study)),
    make=truth,
    title="Truth and the best sets",
    note="Errors are estimate minus truth, in per cent of the truth and of the "
    "search range. An inverse modelling with fitted kinetics takes those of the "
    "optimiser with the lower cost.",
    headings={
        **_HEADINGS,
    },
    group_by="fit",
)
