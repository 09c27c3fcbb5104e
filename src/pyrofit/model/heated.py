"""A small sample that follows a temperature programme."""

from collections.abc import Iterable
from typing import Literal, Self

from pydantic import Field, model_validator

from pyrofit.model.base import AboveZero, Fraction, Number, Part, Temperature
from pyrofit.model.experiment import Experiment


class Baseline(Part):
    """Straight line that a calorimeter shows besides the heat flow of the sample."""

    level_W_kg: Number = Field(
        0.0, description="baseline at the reference temperature, per initial mass [W/kg]"
    )
    slope_W_kgK: Number = Field(0.0, description="slope of the baseline [W/(kg K)]")
    reference_temperature_K: Temperature = Field(
        500.0, description="temperature at which the baseline has its level [K]"
    )


class HeatedExperiment(Experiment):
    """A small sample of one temperature that is heated at a constant rate."""

    heating_rate_K_min: AboveZero = Field(description="nominal heating rate [K/min]")
    gas: str = Field(
        "",
        description="gas around the sample, in words; where it holds oxygen and no reaction has an "
        "oxygen_order, this is told",
    )
    oxygen: Fraction = Field(
        0.0, description="volume fraction of oxygen in that gas [-]; air: 0.209"
    )
    program: Literal["nominal", "measured", "from_temperature", "from_time"] = Field(
        "measured",
        description="temperature over time: measured, or nominal T0 + rate t; `from_temperature`: "
        "files without times, t = (T - T0)/rate; `from_time`: files without temperatures",
    )
    set_point_K: float | None = Field(
        None,
        gt=150.0,
        description="isothermal test: temperature that is held after heating at the nominal rate "
        "[K]; none = the heating goes on",
    )
    hold_s: AboveZero = Field(3600.0, description="synthetic: length of the hold [s]")
    lag_s: Number = Field(
        0.0, description="time by which the sample's temperature lags behind the program's [s]"
    )
    temperature_offset_K: Number = Field(
        0.0, description="sample's temperature minus the recorded one, besides the lag [K]"
    )
    start_temperature_K: AboveZero = Field(
        300.0, description="synthetic, and program `from_time`: first temperature T0 [K]"
    )
    end_temperature_K: AboveZero = Field(850.0, description="synthetic: last temperature [K]")

    def as_simulated(self, signals: Iterable[str]) -> Self:
        """Return the inputs of its curves, which the gas is not."""
        return super().as_simulated(signals).model_copy(update={"gas": ""})

    @model_validator(mode="after")
    def _lag_instead_of_delay(self) -> Self:
        for name, signal in self.signals.items():
            if signal.delay_s != 0.0 or signal.offset != 0.0:
                raise ValueError(
                    f"signal '{name}' of a {self.kind.upper()} experiment takes neither delay_s "
                    "nor offset. A sample behind its programme has lag_s; one whose recorded "
                    f"temperature is wrong has temperature_offset_K{self._other_way_out}"
                )
        if self.set_point_K is not None:
            self._check_hold()
        return self

    def _check_hold(self) -> None:
        """Refuse keys that a hold cannot have."""
        for key, wrong, why in (
            ("lag_s", self.lag_s != 0.0, "a lag has no meaning; use temperature_offset_K"),
            ("program", self.program == "from_temperature", "the files must have times"),
            ("program", self.program == "from_time", "the files must have temperatures"),
        ):
            if wrong:
                raise ValueError(f"{key}: while a temperature is held (set_point_K), {why}")

    @property
    def is_isothermal(self) -> bool:
        """Whether a temperature is held after the heating."""
        return self.set_point_K is not None

    @property
    def _other_way_out(self) -> str:
        return ""

    @property
    def line(self) -> Baseline:
        """Baseline of its heat flow."""
        return NO_BASELINE

    @property
    def response(self) -> float | str:
        """Time constant [s] of the response to its heat release, or its parameter."""
        return 0.0

    @property
    def synthetic_span(self) -> tuple[float, str]:
        """Length of a computed record [K], and the keys that set it."""
        span = self.end_temperature_K - self.start_temperature_K
        return span, "start_temperature_K and end_temperature_K"


NO_BASELINE = Baseline()
