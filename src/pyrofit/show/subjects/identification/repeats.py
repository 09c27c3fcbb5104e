"""Repeats of tests, and their differences beside the stated scatter."""

import pandas as pd

from pyrofit.analysis.estimates import estimates_of
from pyrofit.analysis.repeats import Differing, RepeatOfTest, has_repeats, repeats_of_tests
from pyrofit.config import Study
from pyrofit.config.expand.nuisances import NUISANCES
from pyrofit.results import identification
from pyrofit.results.files import Results
from pyrofit.show.names import STAGES
from pyrofit.show.table import Row, Table


def repeats_table(study: Study, results: Results) -> pd.DataFrame:
    """List the repeats of every test with their signals and the values that differ.

    Returns
    -------
    pandas.DataFrame
        One row per repeat and value that differs; one row for a repeat without any.
    """
    estimates = estimates_of(study, identification.read(study, results))
    rows = [
        _row(study, repeat, one)
        for repeat in repeats_of_tests(study, estimates)
        for one in repeat.differing or (None,)
    ]
    return pd.DataFrame(rows).dropna(axis="columns", how="all")


def _row(study: Study, repeat: RepeatOfTest, one: Differing | None) -> Row:
    words = study.experiments[repeat.name].words
    about: Row = {
        "test": repeat.test,
        "repeat": repeat.name,
        "signals": ", ".join(words(signal) for signal in repeat.signals),
        "missing": ", ".join(repeat.missing) or None,
    }
    if one is None:
        return about
    estimate = one.estimate
    return {
        **about,
        "fit": STAGES[estimate.stage],
        "differs": NUISANCES[one.key].label,
        "unit": estimate.unit,
        "stated_sd": one.sd,
        "estimate": estimate.value,
        "low": estimate.low,
        "high": estimate.high,
        "away_sd": one.away_sd,
    }


TABLE = Table(
    place=16,
    applies=has_repeats,
    make=repeats_table,
    title="Repeats and their differences",
    note="Repeats are fitted together and never averaged. Stated sd: standard deviation between "
    "repeats, given under `repeats`. Distance: estimate minus the value of no difference, over "
    "the stated sd; beyond 2 the repeats differ by more than is stated.",
    headings={
        "missing": "signals that it lacks",
        "differs": "what differs",
        "stated_sd": "stated sd",
        "low": "95 % low",
        "high": "95 % high",
        "away_sd": "distance [sd]",
    },
    group_by="test",
)
