"""Options of the worth of planned tests."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from pyrofit.model.base import Part


def _two_or_none(count: int) -> int:
    if count == 1:
        raise ValueError("'1': give a whole number from 2 to 1000, or 0 for no check")
    return count


class WorthOptions(Part):
    """Worth of planned tests, `snakemake worth`."""

    draws: Annotated[int, AfterValidator(_two_or_none)] = Field(
        50, ge=0, le=1000, description="drawn data sets that check the best three; 0 = no check"
    )
    apparatus: Literal["exact", "uncertain"] = Field(
        "exact",
        description="flux, thickness, heat losses and temperatures are as described, or uncertain "
        "by their standard deviations",
    )


OPTIONS = WorthOptions
