"""Stored sets scored again: computed once, read by tables, figures and sentences."""

import pandas as pd
from pydantic import Field

from pyrofit.results.files import Results, read_csv
from pyrofit.results.record import OfStudy, Record, StepResult

FILE = "rescore.json"
SETS = "sets.csv.gz"
SCORES = "scores.csv.gz"
CORRELATION = "correlation.csv"
AMONG_BEST = "correlation_best.csv"
EXCESS = "excess.csv"
BETTER = "better.csv"


class OfRange(Record):
    """Where a parameter lies in the valley of a cost, in fractions of its limits."""

    low: float = Field(description="lowest value over the best sets")
    high: float = Field(description="highest value over the best sets")
    best: float = Field(description="value of the best set")


class OfMeasure(Record):
    """A cost, its best stored set, and where its valley lies."""

    name: str = Field(description="name of the cost")
    words: str = Field(description="name in words")
    signals: list[str] = Field(description="the signals that it compares")
    tells_apart: bool = Field(description="it does not give all sets the same value")
    value: float = Field(description="value of its best set")
    set_number: int = Field(description="the best set, a row of sets.csv.gz")
    fitted_with: str = Field(description="cost function of the search that met the best set")
    parameters: dict[str, float] = Field(description="the best set, SI units")
    valley_sets: int = Field(description="number of its best sets, which make the valley")
    valley: dict[str, OfRange] = Field(description="the valley by parameter")


class Rescored(OfStudy):
    """The result."""

    stored: int = Field(description="stored model calls that finished")
    failed: int = Field(description="stored model calls that did not finish; they are left out")
    sampled: int = Field(description="sets that were scored")
    histories: int = Field(description="searches whose calls are stored")
    unfinished: int = Field(description="scored sets whose run did not finish; they are left out")
    drift: float = Field(description="largest relative difference of stored and recomputed cost")
    left_out: list[str] = Field(description="costs that cannot be computed, and why")
    valley_share: float = Field(description="share of the sets that makes a valley")
    same: list[list[str]] = Field(description="costs that rank the sets in the same order")
    measures: list[OfMeasure] = Field(min_length=1, description="the costs")


RESULT = StepResult(
    "rescore",
    FILE,
    Rescored,
    lambda study, found: all({*m.parameters} == {*study.imp.estimate} for m in found.measures),
)
write, read = RESULT.write, RESULT.read


def matrix(results: Results, name: str) -> pd.DataFrame:
    """Return a square table of the costs, by name."""
    return read_csv(results.of_step("rescore", name), {"cost": object}).set_index("cost")
