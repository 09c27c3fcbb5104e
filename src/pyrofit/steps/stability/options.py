"""Options of the stability of a diagnosis."""

from pydantic import Field

from pyrofit.model.base import Part


class StabilityOptions(Part):
    """The diagnosis on disturbed data, `snakemake stability`."""

    draws: int = Field(8, ge=2, le=200, description="disturbed data sets that are diagnosed")


OPTIONS = StabilityOptions
