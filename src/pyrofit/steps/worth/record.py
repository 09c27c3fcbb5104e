"""Data worth: computed once, read by table, figure and sentences."""

from typing import Literal

from pydantic import Field

from pyrofit.results.record import OfStudy, Record, StepResult

FILE = "worth.json"


class Sds(Record):
    """Standard deviations, by name."""

    parameters: dict[str, float] = Field(description="of the parameters, in their units")
    predictions: dict[str, float] = Field(
        description="of predicted curves, root mean square over the record, SI units"
    )


class OfTest(Record):
    """A planned test."""

    name: str = Field(description="short name")
    words: str = Field(description="name in words")
    quantities: list[str] = Field(description="quantities that it records")
    gain_bit: float = Field(description="information gained [bit]")
    left: float = Field(
        description="geometric mean of all standard deviations over the present ones"
    )
    sds: Sds = Field(description="with this test, linear")
    checked: Sds | None = Field(description="the same from refits of drawn data; none = not made")


class OfPrediction(Record):
    """A predicted curve."""

    experiment: str = Field(description="experiment that is not fitted")
    signal: str = Field(description="signal")


class Worth(OfStudy):
    """The result."""

    points: int = Field(description="measured points so far")
    dispersion: float = Field(description="chi-square per degree of freedom, 1 at least")
    apparatus: Literal["exact", "uncertain"] = Field(description="how the apparatus is taken")
    draws: int = Field(description="drawn data sets of the check")
    estimate: dict[str, float] = Field(description="best fit, in the parameters' units")
    now: Sds = Field(description="with the data so far, linear")
    now_checked: Sds | None = Field(description="the same from refits")
    predictions: dict[str, OfPrediction] = Field(description="predicted curves, by name")
    tests: list[OfTest] = Field(min_length=1, description="the tests, the best first")
    left_out: list[str] = Field(description="tests whose simulation does not finish")


RESULT = StepResult(
    "worth", FILE, Worth, lambda study, found: {*study.imp.estimate} <= {*found.estimate}
)
write, read = RESULT.write, RESULT.read
