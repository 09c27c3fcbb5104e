"""The base of the records that result files are checked against."""

from pydantic import BaseModel, ConfigDict


class Record(BaseModel):
    """A part of a result; its keys are exactly these, each of its own type."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid", allow_inf_nan=False)
