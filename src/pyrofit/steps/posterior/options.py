"""Options of the draws from the posterior."""

from pydantic import Field

from pyrofit.model.base import Part


class PosteriorOptions(Part):
    """Draws from the posterior of the parameters, `snakemake posterior`."""

    sets: int = Field(100, ge=1, le=9999, description="sets of the ensemble that is written")
    steps: int = Field(3000, ge=20, le=1_000_000, description="steps of each sampler at most")


OPTIONS = PosteriorOptions
