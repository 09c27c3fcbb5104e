"""A property over temperature, in words."""

from typing import Annotated, Any, Self

from pydantic import Discriminator, Field, Tag, model_validator

from pyrofit.model.base import POSITIVE, Number, Part, Positive, Rule

RESOLVED = Rule(
    lambda x: x >= 4.0, "must be at least 4 K: a property is known every 5 K, a peak has its area"
)


class Linear(Part):
    """p(T) = value (1 + slope (T - T_ref)), at least 1 % of value."""

    value: Positive = Field(description="p at the reference temperature, unit of the property")
    slope_1_K: Number = Field(description="relative slope [1/K]")
    reference_temperature_K: Positive = Field(300.0, description="T_ref [K]")


class PowerLaw(Part):
    """p(T) = value (T / T_ref)^exponent."""

    value: Positive = Field(description="p at the reference temperature, unit of the property")
    exponent: Number = Field(description="exponent [-]")
    reference_temperature_K: Positive = Field(300.0, description="T_ref [K]")


class Table(Part):
    """p(T) = factor value(T), linear between given points, constant outside them."""

    temperature_K: tuple[float, ...] = Field(description="increasing temperatures [K]")
    value: Annotated[tuple[Number, ...], POSITIVE] = Field(description="p at those temperatures")
    factor: Positive = Field(1.0, description="multiplies all values [-]")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.temperature_K) != len(self.value) or len(self.value) < 2:
            raise ValueError("temperature_K and value need the same length, at least 2")
        if any(b <= a for a, b in zip(self.temperature_K, self.temperature_K[1:], strict=False)):
            raise ValueError("temperature_K must increase")
        return self


class Changed(Part):
    """p(T) = (of(T) (1 + slope (T - T_ref) + bend w L) + step S + peak)/(1 + thinning S).

    It is at least 1 % of of(T). The step is smooth, S = 1/(1 + exp(-x)) with x = (T - T_step)/w and
    w the width; the bend is a change of the slope there, L = ln(1 + exp(x)). The peak is a normal
    distribution of area ``peak_area`` about T_peak with the standard deviation ``peak_width_K``.
    ``scale`` multiplies slope, bend, step, peak and thinning, so that the changes of several
    properties can have one strength.
    """

    of: "Property" = Field(description="the property without these changes")
    slope_1_K: Number = Field(0.0, description="relative slope [1/K]")
    reference_temperature_K: Positive = Field(475.0, description="T_ref [K]")
    scale: Number = Field(
        1.0, description="multiplies slope, bend, step, peak and thinning; any unit"
    )
    bend: Number = Field(
        0.0,
        description="relative slope from the temperature of the step on [1/K, over the unit of "
        "scale]",
    )
    thinning: Number = Field(
        0.0, description="p is divided by 1 + thinning above the temperature of the step [-]"
    )
    step: Number = Field(0.0, description="height of the step, unit of the property")
    step_temperature_K: Positive = Field(390.0, description="temperature of the step [K]")
    step_width_K: Positive = Field(8.0, description="width of the step [K]")
    peak_area: Number = Field(0.0, description="area of the peak, unit of the property times K")
    peak_temperature_K: Positive = Field(450.0, description="temperature of the peak [K]")
    peak_width_K: Annotated[Number, RESOLVED] = Field(
        15.0, description="standard deviation of the peak [K]"
    )


def _form(given: Any) -> str:
    keys = given if isinstance(given, dict) else getattr(type(given), "model_fields", None)
    if keys is None:
        return "number"
    if "temperature_K" in keys:
        return "table"
    if "of" in keys:
        return "changed"
    return "power law" if "exponent" in keys else "linear"


Property = Annotated[
    Annotated[Number, Tag("number")]
    | Annotated[Linear, Tag("linear")]
    | Annotated[PowerLaw, Tag("power law")]
    | Annotated[Table, Tag("table")]
    | Annotated[Changed, Tag("changed")],
    Discriminator(_form),
    POSITIVE,
]
"""A number or parameter; {value, slope_1_K}; {value, exponent}; {temperature_K, value}, or
{of, ...}."""
Changed.model_rebuild()
