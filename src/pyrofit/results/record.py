"""Records: what a result file holds, from the code that writes it to the code that reads it."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from pyrofit.config import Study
from pyrofit.errors import DataError
from pyrofit.results.files import Results, read_json, write_json
from pyrofit.results.needed import AGAIN

_WRONG = {
    "missing": "is missing in this result",
    "float_type": "is not a finite number",
    "finite_number": "is not a finite number",
    "int_type": "is not a whole number",
    "string_type": "is not text",
    "bool_type": "is not true or false",
    "list_type": "is not a list",
    "too_short": "is not a list of at least one",
    "dict_type": "is not a mapping",
    "model_type": "is not a mapping",
    "extra_forbidden": "is not a key of this result",
}


class Record(BaseModel):
    """A part of a result; its keys are exactly these, each of its own type."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", allow_inf_nan=False)


class OfStudy(Record):
    """The result of a step."""

    study: str = Field(description="name of the study")


Made = TypeVar("Made", bound=Record)
Whole = TypeVar("Whole", bound=OfStudy)
Kind = TypeVar("Kind")


def write_record(path: Path, record: Record) -> None:
    """Write a record as JSON, whole or not at all; its keys stand in the order of its fields."""
    write_json(path, record.model_dump(by_alias=True))


def read_record(
    path: Path, kind: type[Made], is_ours: Callable[[Made], bool] = lambda record: True
) -> Made:
    """Return a record from its file; ``is_ours`` tells whether it is of the study at hand.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    found = made_of(path, kind, read_json(path))
    if not is_ours(found):
        raise DataError(f"{path}: this is the result of another study; {AGAIN}")
    return found


@dataclass(frozen=True)
class StepResult(Generic[Whole]):
    """The file of a step's result.

    Parameters
    ----------
    step, file, kind
        Names of step and file, and the class of the record.
    agrees
        Function that tells whether a record agrees with a study of the same name.
    """

    step: str
    file: str
    kind: type[Whole]
    agrees: Callable[[Study, Whole], bool] = lambda study, found: True

    def write(self, results: Results, found: Whole) -> None:
        """Write the result."""
        write_record(results.of_step(self.step, self.file), found)

    def read(self, study: Study, results: Results) -> Whole:
        """Return the result.

        Raises
        ------
        DataError
            It is missing, broken, or that of another study.
        """

        def is_ours(found: Whole) -> bool:
            return found.study == study.name and self.agrees(study, found)

        return read_record(results.of_step(self.step, self.file), self.kind, is_ours)


def made_of(path: Path, kind: type[Kind], content: object) -> Kind:
    """Return records of the content of a file.

    Raises
    ------
    DataError
        The content is not of this kind.
    """
    try:
        return TypeAdapter(kind).validate_python(content)
    except ValidationError as error:
        raise DataError(f"{path}: {_said(error)}; {AGAIN}") from None


def _said(error: ValidationError) -> str:
    """Return the first error in words."""
    first = error.errors()[0]
    place = ".".join(str(key) for key in first["loc"])
    if first["type"] == "literal_error":
        return f"'{place}' is '{first['input']}', not one of {first['ctx']['expected']}"
    return f"'{place}' {_WRONG.get(first['type'], first['msg'])}"


def check_names(path: Path, place: str, found: Mapping[str, object], names: Iterable[str]) -> None:
    """Refuse a result that lacks an item of a mapping, such as the value of a parameter.

    Raises
    ------
    DataError
        With the first one.
    """
    for name in names:
        if name not in found:
            here = f"{place}.{name}".removeprefix(".")
            raise DataError(f"{path}: '{here}' is missing in this result; {AGAIN}")
