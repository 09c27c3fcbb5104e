"""Options of the sensitivity analysis."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from pyrofit.model.base import Part

LEAST = 8
"""Base points at least."""


def _power_of_two(count: int) -> int:
    if count < LEAST or count & (count - 1):
        raise ValueError(f"'{count}': give a power of two from {LEAST}, such as 256 or 1024")
    return count


class SensitivityOptions(Part):
    """Sensitivity of signals over time and of costs, `snakemake sensitivity`."""

    within: Literal["limits", "near", "intervals"] = Field(
        "limits",
        description="estimated parameters vary over their limits, near the estimates, or within "
        "the intervals of the estimates",
    )
    samples: Annotated[int, AfterValidator(_power_of_two)] = Field(
        1024, description="base points, a power of two from 8"
    )


OPTIONS = SensitivityOptions
