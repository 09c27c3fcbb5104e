"""The answer: one value of each parameter, with its interval and verdict."""

import pandas as pd

from pyrofit.analysis.answer import one_each
from pyrofit.analysis.estimates import Estimated, estimates_of
from pyrofit.config import Study
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.names import STAGES, verdict_of
from pyrofit.show.table import Row, Table


def answer(study: Study, results: Results) -> pd.DataFrame:
    """List value, 95 % interval and verdict by parameter, in its own unit; each has one row."""
    found = one_each(study, estimates_of(study, identification.read(study, results)))
    return pd.DataFrame([_row(study, e) for e in found])


def _row(study: Study, e: Estimated) -> Row:
    row: Row = {"fit": STAGES[e.stage], "parameter": e.name}
    # A column that is empty for all parameters is not shown.
    row |= {"name": study.parameters[e.name].label or None, "unit": e.unit}
    row |= {"estimate": e.value, "low": e.low, "high": e.high, "apparatus": e.apparatus or None}
    row["most"] = e.most or None
    row["verdict"] = verdict_of(e)
    return row if study.synthetic is None else {**row, "truth": study.synthetic.truth.get(e.name)}


TABLE = Table(
    place=10,
    make=answer,
    title="The answer: values, 95 % intervals and verdicts",
    note="These values maximise the likelihood, which weighs each point by its noise and holds "
    "known values. Where a model misses its tests, they are those of least squares. Exports, "
    "predictions and the posterior take this set. Use its values together. "
    "± by the apparatus: 1.96 standard deviations by its usual errors, which the intervals of a "
    "model that misses the tests contain.",
    headings={
        "low": "95 % low",
        "high": "95 % high",
        "apparatus": "± by the apparatus",
        "most": "mostly by",
    },
    group_by="fit",
)
