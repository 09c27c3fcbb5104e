"""Options of scoring stored sets again."""

from typing import Annotated, Literal

from pydantic import Field

from pyrofit.model.base import Part


class RescoreOptions(Part):
    """Stored sets scored again under other costs, `snakemake rescore`."""

    costs: tuple[str, ...] = Field(
        (), description="cost functions of the study, or costs of docs/rescore.md; none = all"
    )
    sets: Annotated[int, Field(ge=2, le=1_000_000_000)] | Literal["all"] = Field(
        3000, description="how many sets are scored, or 'all'"
    )


OPTIONS = RescoreOptions
