"""Variance-based sensitivity: written by the stage, read by tables, figures and sentences."""

import json
from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field, ValidationError

from pyrofit.config import Study
from pyrofit.cost import known_costs
from pyrofit.defaults import BASE_POINTS, WITHIN
from pyrofit.errors import DataError
from pyrofit.plugins import code_digest
from pyrofit.results import dependencies
from pyrofit.results.files import Results, read_json, write_json
from pyrofit.results.record import Record

FILE = "sensitivity.json"
CURVES = "curves.csv.gz"
OVER_TIME = "over_time.csv.gz"
COSTS = "costs.csv"
LAST = "costs.svg"
"""File that is written last, so that all others are there when it is."""


class OfInput(Record):
    """Something that varies."""

    name: str = Field(description="a parameter, or a made-up name of a value of the apparatus")
    label: str = Field(description="name in words")
    kind: Literal["estimated", "known", "apparatus"] = Field(description="why it varies")
    experiment: str = Field(description="experiment that it belongs to; empty = all")
    unit: str = Field(description="unit, as the study writes it")
    low: float = Field(description="lowest value, in this unit")
    high: float = Field(description="highest value")
    mean: float = Field(description="mean of the distribution before it is cut off")
    sd: float | None = Field(description="standard deviation of a normal one; none = uniform")
    source: str = Field(description="limits, estimate, default, or where the value is from")


class OfSignal(Record):
    """A signal of a fitted experiment."""

    experiment: str = Field(description="experiment")
    signal: str = Field(description="signal")
    total: dict[str, float] = Field(
        description="by input: total variance over the record, as a share of all variance"
    )
    most: dict[str, float] = Field(description="by input: largest total index at a time")
    most_at_s: dict[str, float] = Field(description="by input: the time of the largest index [s]")


class OfCost(Record):
    """A cost."""

    name: str = Field(description="name of the cost")
    words: str = Field(description="name in words")
    own: bool = Field(description="a cost function of the study")
    signals: list[list[str]] = Field(description="experiment and signal of all it compares")
    at_s: float | None = Field(description="the one time that it looks at [s]; none = all times")
    first: dict[str, float] = Field(description="index of first order by input")
    total: dict[str, float] = Field(description="index of total order by input")


class Sensitivity(Record):
    """The result."""

    study: str = Field(description="name of the study")
    within: Literal["limits", "near", "intervals"] = Field(
        description="where estimated parameters vary"
    )
    samples: int = Field(description="base points of the sample")
    runs: int = Field(description="model calls")
    unfinished: int = Field(description="base points of which a run did not finish; replaced")
    inputs: list[OfInput] = Field(min_length=1, description="inputs that vary")
    signals: list[OfSignal] = Field(min_length=1, description="the signals")
    costs: list[OfCost] = Field(min_length=1, description="the costs")
    same: list[list[str]] = Field(description="costs with equal indices: they differ by a factor")
    left_out: list[str] = Field(description="costs that cannot be computed, and why")


def slice_of(study: Study, within: str = WITHIN, samples: int = BASE_POINTS) -> dict[str, Any]:
    """Return the inputs of the step: the likelihood, all costs and experiments, its options."""
    return {
        "searches": {cost: dependencies.imp(study, cost, "sceua") for cost in study.imp.costs},
        "likelihood": dependencies.identify(study),
        "kinds": {name: code_digest("costs", name) for name in known_costs()},
        "known": {name: known.model_dump() for name, known in study.known.items()},
        "seed": study.seed,
        "options": {"within": within, "samples": samples},
    }


def write(results: Results, content: Mapping[str, Any]) -> None:
    """Write the results; they must agree with the schema."""
    text = json.dumps(content, allow_nan=False)
    Sensitivity.model_validate_json(text)
    write_json(results.sensitivity(FILE), json.loads(text))


def read(study: Study, results: Results) -> Sensitivity:
    """Return the results.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    path = results.sensitivity(FILE)
    try:
        found = Sensitivity.model_validate(read_json(path))
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(key) for key in first["loc"])
        raise DataError(f"{path}: '{place}': {first['msg']}; delete it and run again") from None
    estimated = {one.name for one in found.inputs if one.kind == "estimated"}
    if found.study != study.name or estimated != set(study.imp.estimate):
        raise DataError(f"{path}: this is the result of another study; delete it and run again")
    return found


def exists(results: Results) -> bool:
    """Tell whether the analysis was made and its page drawn."""
    return results.sensitivity(LAST).is_file()
