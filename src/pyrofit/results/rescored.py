"""Stored sets scored again: written by the stage, read by tables, figures and sentences."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from pydantic import Field, ValidationError

from pyrofit.config import Study
from pyrofit.cost import known_costs
from pyrofit.defaults import RESCORED_SETS
from pyrofit.errors import DataError
from pyrofit.plugins import code_digest
from pyrofit.results import dependencies
from pyrofit.results.files import Results, read_csv, read_json, write_json
from pyrofit.results.record import Record

FILE = "rescore.json"
SETS = "sets.csv.gz"
SCORES = "scores.csv.gz"
CORRELATION = "correlation.csv"
AMONG_BEST = "correlation_best.csv"
EXCESS = "excess.csv"
BETTER = "better.csv"
LAST = "valleys.svg"
"""File that is written last, so that all others are there when it is."""


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
    valley_share: float = Field(description="share of the sets that makes a valley")
    left_out: list[str] = Field(description="costs that cannot be computed, and why")
    same: list[list[str]] = Field(description="costs that rank the sets in the same order")
    measures: list[OfMeasure] = Field(min_length=1, description="the costs")


def slice_of(
    study: Study, asked: Sequence[str] = (), count: int | None = RESCORED_SETS
) -> dict[str, Any]:
    """Return the inputs of the step: all searches, the likelihood, experiments, its options."""
    return {
        "searches": {cost: dependencies.imp(study, cost, "sceua") for cost in study.imp.costs},
        "likelihood": dependencies.identify(study),
        "kinds": {name: code_digest("costs", name) for name in known_costs()},
        "options": {"costs": list(asked), "sets": count},
        **dependencies.collect(study),
    }


def write(results: Results, content: Mapping[str, Any]) -> None:
    """Write the results; they must agree with the schema."""
    text = json.dumps(content, allow_nan=False)
    Rescored.model_validate_json(text)
    write_json(results.rescored(FILE), json.loads(text))


def read(study: Study, results: Results) -> Rescored:
    """Return the results.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    path = results.rescored(FILE)
    try:
        found = Rescored.model_validate(read_json(path))
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(key) for key in first["loc"])
        raise DataError(f"{path}: '{place}': {first['msg']}; delete it and run again") from None
    estimated = set(study.imp.estimate)
    if found.study != study.name or any(set(m.parameters) != estimated for m in found.measures):
        raise DataError(f"{path}: this is the result of another study; delete it and run again")
    return found


def matrix(results: Results, name: str) -> pd.DataFrame:
    """Return a square table of the costs, by name."""
    return read_csv(results.rescored(name), {"cost": object}).set_index("cost")


def exists(results: Results) -> bool:
    """Tell whether stored sets were scored and their page drawn."""
    return results.rescored(LAST).is_file()
