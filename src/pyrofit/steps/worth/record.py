"""Data worth: computed once, read by table, figure and sentences."""

from typing import Literal

from pydantic import Field

from pyrofit.config import Study
from pyrofit.results.files import Results
from pyrofit.results.record import Record, read_record, write_record

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


class Worth(Record):
    """The result."""

    study: str = Field(description="name of the study")
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


def write(results: Results, found: Worth) -> None:
    """Write the results."""
    write_record(results.of_step("worth", FILE), found)


def read(study: Study, results: Results) -> Worth:
    """Return the results.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    estimated = set(study.imp.estimate)

    def is_ours(found: Worth) -> bool:
        return found.study == study.name and estimated <= set(found.estimate)

    return read_record(results.of_step("worth", FILE), Worth, is_ours)
