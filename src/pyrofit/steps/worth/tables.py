"""The planned tests and the standard deviations after each of them."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.show.table import Row, Table
from pyrofit.show.units import difference, difference_unit
from pyrofit.steps.worth import record
from pyrofit.steps.worth.facts import label, share_left

NOW = "none: standard deviation now"


def tests(study: Study, results: Results) -> pd.DataFrame:
    """List the present standard deviations, then the shares of them that each test leaves [%]."""
    found = record.read(study, results)
    rows: list[Row] = [_now(study, found)]
    for test in found.tests:
        rows.append(_row(study, found, test.words, test.gain_bit, share_left(found, test)))
        if again := share_left(found, test, checked=True):
            rows.append(_row(study, found, f"{test.words}: refits", None, again))
    return pd.DataFrame(rows)


def _now(study: Study, found: record.Worth) -> Row:
    row: Row = {"test": NOW, "gain_bit": None}
    for name, sd in found.now.parameters.items():
        unit = study.parameters[name].unit
        row[name] = f"{sd:.2g}" + ("" if unit == "-" else f" {unit}")
    for name, sd in found.now.predictions.items():
        one = found.predictions[name]
        quantity = study.experiments[one.experiment].quantity(one.signal)
        shown = float(difference(quantity, sd))
        row[label(study, found, name)] = f"{shown:.2g} {difference_unit(quantity)}"
    return row


def _row(
    study: Study, found: record.Worth, words: str, gain: float | None, left: dict[str, float]
) -> Row:
    shown = {label(study, found, name): f"{value:.0f} %" for name, value in left.items()}
    return {"test": words, "gain_bit": None if gain is None else round(gain, 1), **shown}


TABLES = {
    "worth": Table(
        place=60,
        make=tests,
        title="Worth of planned tests",
        note="First row: standard deviations with the data so far, widened by the dispersion. "
        "Other rows: the share that a test leaves of them. Gain: logarithm to base 2 of the factor "
        "by which the volume of the parameters' uncertainty falls. Refits: spread of the "
        "parameters fitted to drawn data with the test, over that without it.",
        headings={"gain_bit": "gain [bit]"},
    ),
}
