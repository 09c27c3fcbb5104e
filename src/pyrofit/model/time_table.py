"""A number of the description that changes with time."""

from collections.abc import Mapping
from typing import Annotated, ClassVar, Self

from pydantic import Field, model_validator

from pyrofit.model.base import ANY, NOT_NEGATIVE, POSITIVE, WARM, Made, Number, Part, value_of


class TimeTable(Part):
    """y(t), linear between given points, constant after the last; two equal times are a step."""

    INHERITS: ClassVar[frozenset[str]] = frozenset({"value"})
    time_s: tuple[float, ...] = Field(description="times [s], not decreasing, from 0")
    value: Annotated[tuple[Number, ...], ANY] = Field(
        description="y at those times, unit of the key"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.time_s) != len(self.value) or not self.time_s:
            raise ValueError(
                f"time_s and value need the same length, at least 1; they have {len(self.time_s)} "
                f"and {len(self.value)}: add or delete points"
            )
        if self.time_s[0] != 0.0:
            raise ValueError("time_s must start at 0, the start of the test; add a point there")
        pairs = zip(self.time_s, self.time_s[1:], strict=False)
        if any(b < a for a, b in pairs):
            raise ValueError("time_s must not decrease; sort the points by time")
        if any(a == b for a, b in zip(self.time_s, self.time_s[2:], strict=False)):
            raise ValueError("a time must not stand more than twice; two equal times are a step")
        return self


OverTime = Number | TimeTable
"""A number, or a table of a study: ``{time_s, value}``, or ``{file, columns, units}``, which
`pyrofit.config.expand.tables` reads."""
FluxOverTime = Annotated[OverTime, NOT_NEGATIVE]
CoefficientOverTime = Annotated[OverTime, NOT_NEGATIVE]
TemperatureOverTime = Annotated[OverTime, POSITIVE, WARM]


def at_start(given: float | str | TimeTable, values: Mapping[str, Made]) -> float | Made:
    """Return the value at t = 0, that of a number at any time.

    >>> at_start(TimeTable(time_s=(0.0, 9.0), value=(290.0, "T")), {"T": 300.0})
    290.0
    """
    return value_of(given.value[0] if isinstance(given, TimeTable) else given, values)
