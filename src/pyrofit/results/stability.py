"""Stability of a diagnosis: written by draw, read by tables, figure and sentences."""

import json
from collections.abc import Mapping
from typing import Any

from pydantic import Field, ValidationError

from pyrofit.config import Study, digest
from pyrofit.errors import DataError
from pyrofit.provenance import source_fingerprint
from pyrofit.results import dependencies
from pyrofit.results.diagnosis_candidates import OfStrength
from pyrofit.results.diagnosis_schema import Kind, OfGap
from pyrofit.results.files import Results, read_json, write_json
from pyrofit.results.record import Record

LAST = "stability.svg"
"""File that is written last, so that all others are there when it is."""


class OfDraw(Record):
    """The diagnosis of the measured data, disturbed by one draw of their noise."""

    study: str = Field(description="name of the study")
    origin: str = Field(description="digest of its inputs and of the source code")
    draw: int = Field(description="number of the draw, from 0")
    disturbance: float = Field(description="part of the noise by which the data are changed [-]")
    kind: Kind = Field(description="kind of verdict")
    confirmed: bool = Field(description="the verdict is confirmed, as in `diagnosis.json`")
    effects: list[str] = Field(description="effects as in `verdict.effects` of `diagnosis.json`")
    final: list[str] = Field(description="effects of the final model of the search")
    chi2: float = Field(description="chi-square of the final model")
    strengths: dict[str, OfStrength] = Field(
        description="parameters of these effects, by effect and name"
    )
    gap: list[OfGap] = Field(description="misfit before and after, by signal")


def draw_file(number: int) -> str:
    """Return the name of the file of a draw."""
    return f"draw_{number}.json"


def slice_of(study: Study) -> dict[str, Any]:
    """Return the inputs of a draw, which are those of the diagnosis."""
    return dependencies.diagnose(study)


def write(results: Results, content: Mapping[str, Any]) -> None:
    """Write the result of a draw; it must agree with the schema."""
    text = json.dumps(content, allow_nan=False)
    found = OfDraw.model_validate_json(text)
    write_json(results.stability(draw_file(found.draw)), json.loads(text))


def read(study: Study, results: Results) -> list[OfDraw]:
    """Return the results of all draws of a study.

    Raises
    ------
    DataError
        One is missing, broken, or that of another study.
    """
    return [_read(study, results, number) for number in range(study.diagnosis.draws)]


def _read(study: Study, results: Results, number: int) -> OfDraw:
    path = results.stability(draw_file(number))
    try:
        found = OfDraw.model_validate(read_json(path))
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(key) for key in first["loc"])
        raise DataError(f"{path}: '{place}': {first['msg']}; delete it and run again") from None
    if found.study != study.name or found.draw != number:
        raise DataError(f"{path}: this is the result of another study; delete it and run again")
    return found


def origin(study: Study) -> str:
    """Return the digest of all that a draw depends on."""
    return digest([slice_of(study), source_fingerprint("pyrofit.stages.stability")])


def is_current(study: Study, results: Results) -> bool:
    """Tell whether the stability of a diagnosis was tested, and of the study as it is now.

    Its draws take long: after a change they are not repeated unless they are asked for.
    """
    if not results.stability(LAST).is_file():
        return False
    try:
        return {draw.origin for draw in read(study, results)} == {origin(study)}
    except DataError:
        return False


def version(study: Study, results: Results) -> str:
    """Return the digest of the draws that are shown, empty if there are none of this study."""
    if not is_current(study, results):
        return ""
    return digest([draw.model_dump() for draw in read(study, results)])
