"""The record of one quantity: its file, its noise, its clock."""

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from pyrofit.data.noise import FloatArray, autoregressive, lowest_density, moving_average
from pyrofit.model.base import NOT_NEGATIVE, AboveZero, Number, Part

TIMING_S = 0.5
"""Error of the clocks [s]: a tenth of the usual 5-s bins."""
Follows = Literal["material", "fixture"]


RECORD = (
    "uncertainty",
    "uncertainty_meaning",
    "uncertainty_sds",
    "lasting_sd",
    "timing_s",
    "sample_mass_kg",
    "sample_area_m2",
    "relative_to",
    "until_K",
    "until_s",
    "noise",
    "every",
)
"""Keys of a signal that tell of its record, besides its file: no simulation depends on them."""


class Noise(Part):
    """Noise of a computed measurement, white unless one of the two correlations is given."""

    sd: float = Field(ge=0.0, description="standard deviation, SI unit of the quantity")
    autocorrelation: tuple[float, ...] = Field(
        (), description="autocorrelation [-] at lags 1, 2 ... points, none beyond"
    )
    ar: float = Field(0.0, description="autocorrelation [-] ar^k at lag k")

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.autocorrelation and self.ar:
            raise ValueError("autocorrelation and ar describe two kinds of noise; give one")
        if not -1.0 < self.ar < 1.0:
            raise ValueError(f"ar {self.ar:g} must lie between -1 and 1")
        lowest = lowest_density(self.autocorrelation)
        if lowest < -1e-9:
            given = ", ".join(f"{r:g}" for r in self.autocorrelation)
            raise ValueError(
                f"autocorrelation [{given}] is not positive definite: no noise has it; "
                f"multiply it by {int(1000 / (1 - lowest)) / 1000:g} or less"
            )
        return self

    def correlation(self, points: int) -> FloatArray:
        """Return the autocorrelation [-] at lags 0 ... points - 1, shape (points,)."""
        if self.autocorrelation:
            return moving_average(self.autocorrelation, points)
        return autoregressive(self.ar, points)


def _noise(given: Any) -> Any:
    if isinstance(given, str):
        raise ValueError(f"'{given}' is neither a number nor a mapping with the key sd")
    return {"sd": given} if isinstance(given, int | float) else given


class Signal(Part):
    """One measured quantity of an experiment and where it is found."""

    file: str = Field(
        description="path relative to the study file; 'macfp:<path>' for the MaCFP data base; "
        "'synthetic' for a computed measurement. 'memory': the series is given in Python"
    )
    quantity: str = Field("", description="measured quantity, where the signal has another name")
    columns: dict[str, str] = Field(
        default_factory=dict,
        description="headers of time, value, uncertainty, temperature where not recognised, and of "
        "the limits of a band, lower and upper, for the cost BANDS",
    )
    units: dict[str, str] = Field(
        default_factory=dict, description="units of these columns where the file has none"
    )
    uncertainty: AboveZero | None = Field(
        None, description="constant uncertainty, SI unit of the quantity"
    )
    uncertainty_meaning: str = Field("", description="the uncertainty in words")
    uncertainty_sds: AboveZero = Field(
        1.0,
        description="standard deviations of a point's noise that the uncertainty is",
    )
    lasting_sd: AboveZero | None = Field(
        None,
        description="where no uncertainty is given: standard deviation of the drift of a record, "
        "which lasts over 10 % of it, SI unit. None = 0.003 for a mass fraction, 2 % of the range "
        "for a rate or a heat flow. For the diagnosis: the tolerated discrepancy of models; None = "
        "0.02 for a mass fraction",
    )
    timing_s: float = Field(
        TIMING_S, ge=0.0, description="error of the clock [s]; it counts where the curve is steep"
    )
    average_s: float = Field(
        0.0, ge=0.0, description="width of the bins the values are averages over [s]; 0 = points"
    )
    delay_s: Number = Field(0.0, description="time by which the record is late [s]")
    offset: Number = Field(0.0, description="constant that the record shows in excess, SI unit")
    depth_m: Annotated[Number | None, NOT_NEGATIVE] = Field(
        None, description="in-depth temperature: depth below the initial front [m]"
    )
    follows: Follows | None = Field(
        None,
        description="in-depth temperature: `material` (default), the thermocouple moves with "
        "it; or `fixture`, it keeps its distance from the back face of the sample",
    )
    layer: int | None = Field(
        None, ge=1, description="interface temperature: behind which layer; the front one is 1"
    )
    sample_mass_kg: AboveZero | None = Field(None, description="initial sample mass [kg]")
    sample_area_m2: AboveZero | None = Field(None, description="exposed area [m2]")
    relative_to: Literal["initial mass", "first value"] = Field(
        "initial mass",
        description="mass fraction: `first value` where the sample was dried before the record, so "
        "that it starts below 1",
    )
    endothermic: Literal["positive", "negative"] = Field(
        "positive", description="heat flow: sign that heat taken up has in the file"
    )
    until_K: AboveZero | None = Field(
        None, description="heated samples: use points below this temperature [K]"
    )
    until_s: AboveZero | None = Field(None, description="use points before this time [s]")
    noise: Annotated[Noise, BeforeValidator(_noise)] = Field(
        Noise(sd=0.0),
        description="synthetic: noise; a number is the standard deviation of white noise, SI unit",
    )
    every: AboveZero = Field(
        1.0, description="synthetic: spacing of the points [s], or [K] of a heated sample"
    )

    def as_simulated(self) -> Self:
        """Return the inputs of its curve: not its file, its units, its noise."""
        update = {name: type(self).model_fields[name].default for name in RECORD}
        return self.model_copy(update={**update, "file": "", "columns": {}, "units": {}})
