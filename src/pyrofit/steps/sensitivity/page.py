"""Sensitivity over time: tables and figures, and a section of the report."""

import pandas as pd

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.show.page import page_of_step
from pyrofit.show.table import Row, Table
from pyrofit.steps.sensitivity import record
from pyrofit.steps.sensitivity.facts import distribution, short, shown_costs
from pyrofit.steps.sensitivity.figures import FIGURES
from pyrofit.steps.sensitivity.sentences import sentences


def inputs(study: Study, results: Results) -> pd.DataFrame:
    """List the inputs, and the share of every signal's variance in which it takes part."""
    found = record.read(study, results)
    rows = []
    for one in found.inputs:
        row: Row = {
            "input": short(found, one.name),
            "what": one.label,
            "kind": one.kind,
            "distribution": distribution(one),
            "unit": one.unit,
        }
        for signal in found.signals:
            row[f"{signal.experiment} {signal.signal}"] = round(signal.total[one.name], 3)
        rows.append(row)
    return pd.DataFrame(rows)


def costs_table(study: Study, results: Results) -> pd.DataFrame:
    """List the total index of every cost with its interval, in words."""
    found = record.read(study, results)
    frame = read_csv(results.of_step("sensitivity", record.COSTS)).fillna(0.0)
    rows = []
    for cost in shown_costs(found):
        own = frame[frame["cost"] == cost.name].set_index("input")
        row: Row = {"cost": cost.name}
        for one in found.inputs:
            total, low, high = own.loc[one.name, ["total", "total_low", "total_high"]]
            row[short(found, one.name)] = f"{total:.2f} ({low:.2f} to {high:.2f})"
        rows.append(row)
    return pd.DataFrame(rows)


TABLES = {
    "inputs": Table(
        place=60,
        make=inputs,
        title="Inputs, and their part in the variance of the signals",
        note="Part: total variance of an input over the record, divided by all variance. Parts add "
        "up to more than 1 where inputs act in combination. 'Over that described': a factor, or a "
        "difference where the unit is not '-'.",
        headings={"what": "what it is"},
    ),
    "costs": Table(
        place=70,
        make=costs_table,
        title="Total index of the costs",
        note="With the 95 % interval of the bootstrap.",
        shown=False,
    ),
}


PAGE = page_of_step(
    "sensitivity",
    heading="Sensitivity of signals and costs",
    text="Variance-based sensitivity: parameters and values of the apparatus vary together, and "
    "the variance of signals and costs is shared out between them.",
    tables=TABLES,
    figures=FIGURES,
    sentences=sentences,
)
