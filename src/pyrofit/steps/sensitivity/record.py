"""Variance-based sensitivity: computed once, read by tables, figures and sentences."""

from typing import Literal

from pydantic import Field

from pyrofit.config import Study
from pyrofit.results.record import OfStudy, Record, StepResult

FILE = "sensitivity.json"
CURVES = "curves.csv.gz"
OVER_TIME = "over_time.csv.gz"
COSTS = "costs.csv"
Kind = Literal["estimated", "known", "apparatus"]
"""Why an input varies."""


class OfInput(Record):
    """Something that varies."""

    name: str = Field(description="a parameter, or a made-up name of a value of the apparatus")
    label: str = Field(description="name in words")
    kind: Kind = Field(description="why it varies")
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


class Sensitivity(OfStudy):
    """The result."""

    within: Literal["limits", "near", "intervals"] = Field(
        description="where estimated parameters vary"
    )
    samples: int = Field(description="base points of the sample")
    runs: int = Field(description="model calls")
    unfinished: int = Field(description="base points of which a run did not finish; replaced")
    left_out: list[str] = Field(description="costs that cannot be computed, and why")
    inputs: list[OfInput] = Field(min_length=1, description="inputs that vary")
    signals: list[OfSignal] = Field(min_length=1, description="the signals")
    costs: list[OfCost] = Field(min_length=1, description="the costs")
    same: list[list[str]] = Field(description="costs with equal indices: they differ by a factor")


def _agrees(study: Study, found: Sensitivity) -> bool:
    named = {one.name for one in found.inputs if one.kind == "estimated"}
    return named == {*study.imp.estimate}


RESULT = StepResult("sensitivity", FILE, Sensitivity, _agrees)
write, read = RESULT.write, RESULT.read
