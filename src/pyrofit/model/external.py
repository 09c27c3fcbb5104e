"""An experiment that an external program simulates."""

from collections.abc import Iterable
from typing import Self

from pydantic import Field, model_validator

from pyrofit.errors import suggest
from pyrofit.model.base import AboveZero
from pyrofit.model.experiment import Experiment
from pyrofit.model.program import Program
from pyrofit.quantities import known_quantities
from pyrofit.quantities.base import Quantity


class ExternalExperiment(Experiment):
    """Any test that an external program simulates."""

    program: Program = Field(description="the program")
    duration_s: AboveZero = Field(1000.0, description="synthetic: length of the record [s]")

    @model_validator(mode="after")
    def _read(self) -> Self:
        for signal in self.signals:
            if signal not in self.program.reads:
                raise ValueError(
                    f"program.reads: name the file and the columns of the signal '{signal}'"
                )
        for signal in self.program.reads:
            if signal not in self.signals:
                raise ValueError(
                    f"program.reads: there is no signal '{signal}'. {suggest(signal, self.signals)}"
                )
        for signal, reading in self.program.reads.items():
            if reading.abscissa == "temperature":
                self._check_against_temperature(signal)
        return self

    def _check_against_temperature(self, name: str) -> None:
        """Refuse keys that need the time of each point."""
        signal, quantity = self.signals[name], self.quantity(name)
        if not quantity.against_temperature:
            raise ValueError(
                f"program.reads.{name}.columns: {quantity.name} is measured over time; name the "
                "column of the time"
            )
        for key in ("average_s", "delay_s"):
            if getattr(signal, key) != 0.0:
                raise ValueError(
                    f"signals.{name}.{key}: the program gives this signal against temperature, "
                    "without a time; leave it out"
                )
        if signal.file == "synthetic":
            raise ValueError(
                f"signals.{name}.file: a signal against temperature cannot be synthetic, as no "
                "temperature programme is described. Name a measured file, or the column of the "
                "time"
            )

    @property
    def measurable(self) -> dict[str, Quantity]:
        """Every quantity."""
        return known_quantities()

    @property
    def synthetic_span(self) -> tuple[float, str]:
        """Length of a computed record [s], and the keys that set it."""
        return self.duration_s, "duration_s"

    def as_simulated(self, signals: Iterable[str]) -> Self:
        """Return the keys that its curves depend on; every run is read for all signals."""
        program = self.program.model_copy(update={"store": ""})
        return super().as_simulated(self.signals).model_copy(update={"program": program})
