"""Options of the robustness of the cost functions."""

from typing import Annotated

from pydantic import Field

from pyrofit.model.base import Part


class RobustnessOptions(Part):
    """Twins of known truth on which the cost functions are compared, `snakemake robustness`."""

    noise: tuple[Annotated[float, Field(gt=0.0)], ...] = Field(
        (1.0, 3.0, 10.0), min_length=1, description="noise, multiples of the measurement's"
    )
    outliers: tuple[Annotated[float, Field(gt=0.0, lt=1.0)], ...] = Field(
        (0.02, 0.1), min_length=1, description="outliers, shares of the points"
    )
    outlier_size: float = Field(
        0.5, gt=0.0, description="size of an outlier, share of the signal's range"
    )
    draws: int = Field(10, ge=1, description="twins of each level")
    starts: int = Field(
        3, ge=1, le=1_000_000, description="random starts of least squares for each"
    )


OPTIONS = RobustnessOptions
