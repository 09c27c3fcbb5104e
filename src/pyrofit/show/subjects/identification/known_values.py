"""Known values of parameters beside their estimates."""

import pandas as pd

from pyrofit.analysis.estimates import estimates_of
from pyrofit.analysis.known_values import KnownBesideEstimate, has_known, known_values
from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.names import STAGES
from pyrofit.show.table import Row, Table


def known_values_table(study: Study, results: Results) -> pd.DataFrame:
    """List known value, estimate and their distance of each parameter with a known value."""
    estimates = estimates_of(study, identification.read(study, results))
    return pd.DataFrame([_row(known) for known in known_values(study, estimates)])


def _row(known: KnownBesideEstimate) -> Row:
    estimate = known.estimate
    return {
        "fit": STAGES[estimate.stage],
        "parameter": estimate.name,
        "unit": estimate.unit,
        "known": known.value,
        "known_sd": known.sd,
        "source": known.source or None,
        "estimate": estimate.value,
        "low": estimate.low,
        "high": estimate.high,
        "away_sd": known.away_sd,
        "flag": "more than 2 sd away" if known.is_far else None,
    }


TABLE = Table(
    place=15,
    applies=has_known,
    make=known_values_table,
    title="Known values and estimates",
    note="Known: mean and standard deviation (sd) given under `known`. They are data of the "
    "analysis of the likelihood; optimisers of costs search within 3 sd of the known value. "
    "Distance: estimate minus known value, over its sd.",
    headings={
        "known": "known value",
        "known_sd": "its sd",
        "low": "95 % low",
        "high": "95 % high",
        "away_sd": "distance [sd]",
    },
    group_by="fit",
)
