"""Parameters: names for numbers of the description that are estimated or shared."""

from typing import Self

from pydantic import Field, model_validator

from pyrofit.model.base import Part
from pyrofit.model.expressions import names_of

UNITS: dict[str, float] = {
    "-": 1.0,
    "kg/m3": 1.0,
    "kg/m2": 1.0,
    "W/(m K)": 1.0,
    "J/(kg K)": 1.0,
    "kJ/(kg K)": 1e3,
    "J/kg": 1.0,
    "kJ/kg": 1e3,
    "W/(kg K)": 1.0,
    "W/kg": 1.0,
    "W/g": 1e3,
    "J/mol": 1.0,
    "kJ/mol": 1e3,
    "kJ/kmol": 1.0,
    "1/s": 1.0,
    "K": 1.0,
    "m": 1.0,
    "mm": 1e-3,
    "1/m": 1.0,
    "W/m2": 1.0,
    "kW/m2": 1e3,
    "W/(m2 K)": 1.0,
    "W/(m2 K^(4/3))": 1.0,
    "m2 K/W": 1.0,
    "kg/(m2 s)": 1.0,
    "s": 1.0,
    "1/K": 1.0,
    "kg/J": 1.0,
}
"""Factor that takes a value in each unit to SI."""


LONGEST = 300
"""Characters of an expression that a study gives."""


def _check_length(expression: str) -> None:
    if len(expression) > LONGEST:
        raise ValueError(
            f"an expression of {len(expression)} characters; it has at most {LONGEST}. Give parts "
            "of it as parameters with expressions of their own"
        )


class Parameter(Part):
    """A named number; bounds and value are in ``unit``."""

    unit: str = Field(description="unit of value, lower and upper")
    value: float | None = Field(None, description="value where the parameter is not estimated")
    lower: float | None = Field(None, description="lower sampling limit")
    upper: float | None = Field(None, description="upper sampling limit")
    fixed: float | None = Field(
        None,
        description="holds the parameter at this value: no stage estimates it, whatever its limits "
        "and the lists `estimate` are",
    )
    expression: str | None = Field(
        None,
        description="instead of value and limits: arithmetic on other parameters, such as "
        "`0.5 * cp_a`; each parameter counts in its own unit",
    )
    label: str = Field("", description="the parameter in words")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.unit not in UNITS:
            raise ValueError(f"unknown unit '{self.unit}'; known: {', '.join(UNITS)}")
        if self.expression is not None:
            _check_length(self.expression)
            names_of(self.expression)
            if (self.value, self.lower, self.upper, self.fixed) != (None,) * 4:
                raise ValueError(
                    "an expression stands instead of value, limits and fixed; leave them or it out"
                )
            return self
        if (self.lower is None) != (self.upper is None):
            raise ValueError("give both limits, lower and upper, or none")
        if self.lower is not None and self.upper is not None and self.lower >= self.upper:
            raise ValueError(f"lower ({self.lower:g}) must be below upper ({self.upper:g})")
        if self.value is None and self.lower is None:
            raise ValueError(
                "give a value, or limits to estimate it within, or both, or an expression"
            )
        return self

    @property
    def words(self) -> str:
        """Value, limits or expression, with the unit."""
        parts = [] if self.value is None else [f"{self.value:g}"]
        if self.lower is not None and self.upper is not None:
            parts.append(f"{self.lower:g} to {self.upper:g}")
        said = self.expression or ", ".join(parts)
        return said if self.unit == "-" else f"{said} {self.unit}"

    @property
    def factor(self) -> float:
        """Factor from ``unit`` to SI."""
        return UNITS[self.unit]

    @property
    def bounds_si(self) -> tuple[float, float]:
        """Sampling limits in SI units."""
        if self.lower is None or self.upper is None:
            raise ValueError("the parameter has no limits")
        return self.lower * self.factor, self.upper * self.factor
