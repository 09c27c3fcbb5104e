"""Effects that are no candidates."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results import diagnosis
from pyrofit.results.files import Results
from pyrofit.show.diagnosis.words import effect_name
from pyrofit.show.table import Table


def not_tried(study: Study, results: Results) -> pd.DataFrame:
    """List the effects of the catalogue that were not tried, and why."""
    rows = diagnosis.read(study, results).not_tried
    shown = [{"effect": effect_name(row.effect), "reason": row.reason} for row in rows]
    return pd.DataFrame(shown, columns=["effect", "reason"])


TABLE = Table(
    place=300,
    make=not_tried,
    title="Effects that were not tried",
    note="These effects of the catalogue are no candidates in this study.",
)
