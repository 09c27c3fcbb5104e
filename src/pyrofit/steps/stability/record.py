"""Stability of a diagnosis: written by draw, read by tables, figure and sentences."""

from pydantic import Field

from pyrofit.config import Study, calibration_channels, digest, held_out_channels
from pyrofit.data.download import sha256
from pyrofit.errors import DataError
from pyrofit.provenance import source_fingerprint
from pyrofit.results import dependencies, diagnosis
from pyrofit.results.diagnosis_schema import Kind
from pyrofit.results.files import Results, read_json, write_json
from pyrofit.results.record import Record, read_record, write_record
from pyrofit.steps.stability.options import StabilityOptions

GATHERED = "stability.json"
"""File that is written last; it tells from which draws tables and figure are made."""


class OfDraw(Record):
    """The diagnosis of the measured data, disturbed by one draw of their noise."""

    study: str = Field(description="name of the study")
    origin: str = Field(description="digest of its inputs and of the source code")
    draw: int = Field(description="number of the draw, from 0")
    disturbance: float = Field(description="part of the noise by which the data are changed [-]")
    kind: Kind = Field(description="kind of verdict")
    confirmed: bool = Field(description="the verdict is confirmed, as in `diagnosis.json`")
    sets: list[list[str]] = Field(
        description="per effect of the verdict, those that cannot be told from it"
    )
    reasons: list[str] = Field(description="reasons against a firmer verdict, or evidence for it")
    final: list[str] = Field(description="effects of the model that the search ended with")
    chi2: float = Field(description="chi-square of this model")
    strengths: dict[str, float] = Field(description="strengths of its effects, SI units")


def draw_file(number: int) -> str:
    """Return the name of the file of a draw."""
    return f"draw_{number}.json"


def origin(study: Study, results: Results) -> str:
    """Return the digest of all that a draw depends on: study, measurements, source code."""
    channels = (*calibration_channels(study), *held_out_channels(study))
    files = {results.measurement(c.experiment, c.signal) for c in channels}
    measured = [sha256(path) for path in sorted(files) if path.is_file()]
    source = source_fingerprint("pyrofit.steps.stability.compute")
    return digest([dependencies.diagnose_slice(study), measured, source])


def write(results: Results, found: OfDraw) -> None:
    """Write the result of a draw."""
    write_record(results.of_step("stability", draw_file(found.draw)), found)


def read(study: Study, results: Results) -> list[OfDraw]:
    """Return the results of all draws of a study.

    Raises
    ------
    DataError
        One is missing, broken, or that of another version of study, data or source code.
    """
    expected = origin(study, results)
    draws = study.options(StabilityOptions).draws
    return [_read(results, number, expected) for number in range(draws)]


def _read(results: Results, number: int, expected: str) -> OfDraw:
    path = results.of_step("stability", draw_file(number))
    found = read_record(path, OfDraw)
    if found.origin != expected or found.draw != number:
        raise DataError(
            f"{path}: it was made from another version of the study, its data or pyrofit; run "
            "`snakemake stability` again"
        )
    return found


def write_gathered(study: Study, results: Results) -> None:
    """Write from which draws the tables and the figure were made."""
    write_json(results.of_step("stability", GATHERED), {"made_of": _version(study, results)})


def version(study: Study, results: Results) -> str:
    """Return the digest of the draws in tables and figure, empty unless they are up to date.

    Draws take long: after a change they are not repeated unless they are asked for.
    """
    try:
        made_of = str(read_json(results.of_step("stability", GATHERED)).get("made_of"))
        return made_of if made_of == _version(study, results) else ""
    except DataError:
        return ""


def _version(study: Study, results: Results) -> str:
    draws = [draw.model_dump() for draw in read(study, results)]
    return digest([draws, diagnosis.read(study, results).model_dump(by_alias=True)])
