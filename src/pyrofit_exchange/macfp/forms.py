"""Properties of the data base over temperature, and those of a study."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from pyrofit.model.properties import Linear as StudyLinear
from pyrofit.model.properties import PowerLaw as StudyPower
from pyrofit.model.properties import Table as StudyTable

REFERENCE_K = 300.0
_SPAN_K = (200.0, 1600.0)
_JUMP_K = 0.02
"""Distance of the two points that stand for a jump."""
_FLOOR = 0.02
"""Share of the value at 300 K below which a straight line is held."""
_ALIKE = 1e-9


class Form(BaseModel):
    """A form of a property; unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)


class Single(Form):
    """p = Value."""

    form: Literal["Single Value"] = Field(alias="Form")
    value: float = Field(alias="Value", description="unit of the property")


class Table(Form):
    """p linear between points, constant outside."""

    form: Literal["Table"] = Field(alias="Form")
    temperatures: tuple[float, ...] = Field(alias="Temperatures", description="increasing [K]")
    values: tuple[float, ...] = Field(alias="Values", description="as many")


class Line(Form):
    """p = Intercept + Slope T."""

    form: Literal["Linear"] = Field(alias="Form")
    slope: float = Field(alias="Slope", description="per K")
    intercept: float = Field(alias="Intercept", description="value at 0 K")


class Lines(Form):
    """Two straight lines, one below and one above a temperature."""

    form: Literal["Piecewise Linear"] = Field(alias="Form")
    boundary: float = Field(alias="Boundary", description="temperature [K]")
    slope: tuple[float, float] = Field(alias="Slope", description="below, above, per K")
    intercept: tuple[float, float] = Field(alias="Intercept", description="below, above")


class Power(Form):
    """p = Base Value (T/Reference Temperature)^Exponent."""

    form: Literal["Gpyro Power Law"] = Field(alias="Form")
    base: float = Field(alias="Base Value", description="value at the reference temperature")
    exponent: float = Field(alias="Exponent", description="-")
    reference: float = Field(alias="Reference Temperature", description="K")


class Nothing(Form):
    """Not given, or not in the model: an absorption coefficient of an opaque material."""

    form: Literal["None"] = Field(alias="Form")


Curve = Annotated[Single | Table | Line | Lines | Power | Nothing, Field(discriminator="form")]
"""A property of one component."""


class PerComponent(Form):
    """A property of each component, in the order of the composition."""

    form: Literal["Component Specific"] = Field(alias="Form")
    value: tuple[Curve, ...] = Field(alias="Value", description="one form for each component")


class PerReaction(Form):
    """A number for each reaction, in the order of the kinetics."""

    form: Literal["Reaction Specific"] = Field(alias="Form")
    value: tuple[float, ...] = Field(alias="Value", description="one number for each reaction")


def single(value: float) -> Single:
    """Return a constant."""
    return Single(form="Single Value", value=value)


NOTHING = Nothing(form="None")


def to_study(curve: Any) -> float | dict[str, Any] | None:
    """Return a curve as a study writes a property; None where there is none."""
    if isinstance(curve, Nothing):
        return None
    if isinstance(curve, Single):
        return curve.value
    if isinstance(curve, Table):
        return {"temperature_K": list(curve.temperatures), "value": list(curve.values)}
    if isinstance(curve, Power):
        return {
            "value": curve.base,
            "exponent": curve.exponent,
            "reference_temperature_K": curve.reference,
        }
    if isinstance(curve, Line):
        value = curve.intercept + curve.slope * REFERENCE_K
        return {
            "value": value,
            "slope_1_K": curve.slope / value,
            "reference_temperature_K": REFERENCE_K,
        }
    assert isinstance(curve, Lines)
    return _two_lines(curve)


def _two_lines(curve: Lines) -> dict[str, Any]:
    """Return a table with two points below the boundary and two above it.

    Where a line falls below 2 % of its value at the boundary, the table ends and holds that value:
    a property must be above zero.
    """
    T = [0.0, curve.boundary - 0.5 * _JUMP_K, curve.boundary + 0.5 * _JUMP_K, 0.0]
    for end, inner, a, b in (
        (0, 1, curve.intercept[0], curve.slope[0]),
        (3, 2, curve.intercept[1], curve.slope[1]),
    ):
        T[end] = _SPAN_K[0] if end == 0 else _SPAN_K[1]
        least = _FLOOR * (a + b * T[inner])
        if a + b * T[end] < least:
            T[end] = (least - a) / b
    cuts, slopes = np.repeat(curve.intercept, 2), np.repeat(curve.slope, 2)
    return {"temperature_K": T, "value": (cuts + slopes * np.array(T)).tolist()}


def from_study(given: Any) -> Any:
    """Return a property of a study as a curve of the data base.

    Raises
    ------
    TypeError
        It has a form that the data base has no words for.
    """
    if isinstance(given, int | float):
        return single(float(given))
    if isinstance(given, StudyPower):
        return Power(
            form="Gpyro Power Law",
            base=number_or_none(given.value),
            exponent=number_or_none(given.exponent),
            reference=number_or_none(given.reference_temperature_K),
        )
    if isinstance(given, StudyLinear):
        value, slope = number_or_none(given.value), number_or_none(given.slope_1_K)
        T = number_or_none(given.reference_temperature_K)
        return Line(form="Linear", slope=value * slope, intercept=value * (1.0 - slope * T))
    if isinstance(given, StudyTable):
        values = tuple(number_or_none(given.factor) * number_or_none(v) for v in given.value)
        return _lines_of(given.temperature_K, values) or Table(
            form="Table", temperatures=given.temperature_K, values=values
        )
    raise TypeError(f"a property of the form {type(given).__name__}")


def _lines_of(T: tuple[float, ...], values: tuple[float, ...]) -> Lines | None:
    """Return the two lines that a table of four points with a jump stands for."""
    if len(T) != 4 or not math.isclose(T[2] - T[1], _JUMP_K, rel_tol=1e-6):
        return None
    slopes = [(values[i + 1] - values[i]) / (T[i + 1] - T[i]) for i in (0, 2)]
    cuts = [values[i] - b * T[i] for i, b in zip((0, 2), slopes, strict=True)]
    return Lines(
        form="Piecewise Linear",
        boundary=0.5 * (T[1] + T[2]),
        slope=(slopes[0], slopes[1]),
        intercept=(cuts[0], cuts[1]),
    )


def number_or_none(value: float | str) -> float:
    """Return a number; a name of a parameter has none.

    Raises
    ------
    TypeError
        It is a name.
    """
    if isinstance(value, str):
        raise TypeError(f"the parameter '{value}' has no value here")
    return float(value)


def alike(one: Any, other: Any) -> bool:
    """Tell whether two objects are the same, numbers to 1e-9.

    >>> alike({"a": [1.0, 2.0]}, {"a": [1.0 + 1e-12, 2.0]}), alike([1.0], [1.1])
    (True, False)
    """
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(alike(one[k], other[k]) for k in one)
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=_ALIKE, abs_tol=1e-12)
    return bool(one == other)
