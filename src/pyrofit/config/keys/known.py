"""Known values of parameters: independent measurements with standard deviations."""

from pydantic import Field

from pyrofit.model.base import Part


class Known(Part):
    """A measured value of a parameter: a normal distribution."""

    value: float = Field(description="mean, in the parameter's unit")
    sd: float = Field(gt=0.0, description="standard deviation, in the parameter's unit")
    within_sds: float = Field(
        3.0, gt=0.0, description="the parameter is estimated within value -+ this times sd"
    )
    source: str = Field("", description="how it was measured, in words")
