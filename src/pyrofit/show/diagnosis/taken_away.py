"""Effects that the search ended with, and that are not claimed."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.table import Table


def taken_away(study: Study, results: Results) -> pd.DataFrame:
    """List the effects that were taken away, in order, with the test that each fails."""
    rows = diagnosis.read(study, results).verdict.taken_away
    return pd.DataFrame([{"effect": effect_name(row.effect), "reason": row.reason} for row in rows])


TABLE = Table(
    place=610,
    make=taken_away,
    title="Effects that are not claimed",
    note="The search ended with these effects as well. Each was taken away, in this order, because "
    "it fails a test of a claim; the others were then judged again.",
)
