"""Stored sets scored again: computed once, read by tables, figures and sentences."""

import pandas as pd
from pydantic import Field

from pyrofit.config import Study
from pyrofit.results.files import Results, read_csv
from pyrofit.results.record import Record, read_record, write_record

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


class Rescored(Record):
    """The result."""

    study: str = Field(description="name of the study")
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


def write(results: Results, found: Rescored) -> None:
    """Write the results."""
    write_record(results.of_step("rescore", FILE), found)


def read(study: Study, results: Results) -> Rescored:
    """Return the results.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    estimated = set(study.imp.estimate)

    def is_ours(found: Rescored) -> bool:
        same = all(set(m.parameters) == estimated for m in found.measures)
        return found.study == study.name and same

    return read_record(results.of_step("rescore", FILE), Rescored, is_ours)


def matrix(results: Results, name: str) -> pd.DataFrame:
    """Return a square table of the costs, by name."""
    return read_csv(results.of_step("rescore", name), {"cost": object}).set_index("cost")
