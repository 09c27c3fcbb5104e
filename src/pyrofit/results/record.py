"""Records: what a result file holds, from the code that writes it to the code that reads it."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from pyrofit.errors import DataError
from pyrofit.results.files import read_json, write_json
from pyrofit.results.needed import AGAIN


class Record(BaseModel):
    """A part of a result; its keys are exactly these, each of its own type."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", allow_inf_nan=False)


Made = TypeVar("Made", bound=Record)


def write_record(path: Path, record: Record) -> None:
    """Write a record as JSON, whole or not at all; its keys stand in the order of its fields."""
    write_json(path, record.model_dump())


def read_record(
    path: Path, kind: type[Made], is_ours: Callable[[Made], bool] = lambda record: True
) -> Made:
    """Return a record from its file; ``is_ours`` tells whether it is of the study at hand.

    Raises
    ------
    DataError
        It is missing, broken, or that of another study.
    """
    try:
        found = kind.model_validate(read_json(path))
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(key) for key in first["loc"])
        raise DataError(f"{path}: '{place}': {first['msg']}; {AGAIN}") from None
    if not is_ours(found):
        raise DataError(f"{path}: this is the result of another study; {AGAIN}")
    return found
