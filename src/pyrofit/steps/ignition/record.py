"""Times to ignition as they are written and read."""

from pydantic import Field

from pyrofit.results.record import OfStudy, Record, StepResult

FILE = "ignition.json"


class OfIgnition(Record):
    """A test."""

    experiment: str = Field(description="name of the experiment")
    flux_W_m2: float = Field(description="radiant flux [W/m2]")
    time_s: dict[str, float | None] = Field(
        description="time to ignition by definition [s]; none = no ignition"
    )


class OfLine(Record):
    """The line of a relation through the times of a definition."""

    definition: str = Field(description="definition of the time")
    law: str = Field(description="relation: thick, janssens or thin")
    tests: int = Field(description="tests with ignition")
    critical_W_m2: float | None = Field(description="critical heat flux [W/m2]")
    critical_within: list[float] | None = Field(description="its 95 % interval")
    response: float | None = Field(
        description="thermal response parameter [W s^(1/2)/m2]; of a thin solid rho c L dT [J/m2]"
    )
    response_within: list[float] | None = Field(description="its 95 % interval")
    ignition_K: float | None = Field(description="temperature of ignition from the critical flux")
    scatter: float | None = Field(description="root mean square of ln(t / t of the line)")
    remarks: list[str] = Field(
        description="numbers that are not determined, and contradictions to the tests"
    )


class Ignition(OfStudy):
    """The result."""

    tests: list[OfIgnition] = Field(description="the tests")
    series: list[OfLine] = Field(description="the lines")
    left_out: list[str] = Field(description="slabs without a rate, or without a number as flux")


RESULT = StepResult("ignition", FILE, Ignition)
write, read = RESULT.write, RESULT.read
