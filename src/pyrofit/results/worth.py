"""Data worth: written by the stage, read by table, figure and sentences."""

import json
from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field, ValidationError

from pyrofit.config import Study
from pyrofit.defaults import APPARATUS, DRAWS
from pyrofit.errors import DataError
from pyrofit.plugins import code_digest
from pyrofit.quantities import known_quantities
from pyrofit.results import dependencies
from pyrofit.results.files import Results, read_json, write_json
from pyrofit.results.record import Record

FILE = "worth.json"
LAST = "worth.svg"
"""File that is written last, so that all others are there when it is."""


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


class Predicted(Record):
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
    predictions: dict[str, Predicted] = Field(description="predicted curves, by name")
    tests: list[OfTest] = Field(min_length=1, description="the tests, the best first")
    left_out: list[str] = Field(description="tests whose simulation does not finish")


def slice_of(study: Study, draws: int = DRAWS, apparatus: str = APPARATUS) -> dict[str, Any]:
    """Return the inputs of the step: all data that are fitted, predicted signals, its options."""
    kinetics = dependencies.kinetics(study) if study.imp.kinetics == "fitted" else {}
    return {
        "likelihood": dependencies.identify(study),
        "kinetics": kinetics,
        "validation": dependencies.validation(study),
        # New tests may record any quantity.
        "quantities": {n: code_digest("quantities", n) for n in known_quantities()},
        "seed": study.seed,
        "options": {"draws": draws, "apparatus": apparatus},
    }


def write(results: Results, content: Mapping[str, Any]) -> None:
    """Write the results; they must agree with the schema."""
    text = json.dumps(content, allow_nan=False)
    Worth.model_validate_json(text)
    write_json(results.worth(FILE), json.loads(text))


def read(study: Study, results: Results) -> Worth:
    """Return the results.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    path = results.worth(FILE)
    try:
        found = Worth.model_validate(read_json(path))
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(key) for key in first["loc"])
        raise DataError(f"{path}: '{place}': {first['msg']}; delete it and run again") from None
    if found.study != study.name or not set(study.imp.estimate) <= set(found.estimate):
        raise DataError(f"{path}: this is the result of another study; delete it and run again")
    return found


def exists(results: Results) -> bool:
    """Tell whether the worth of tests was computed and its page drawn."""
    return results.worth(LAST).is_file()
