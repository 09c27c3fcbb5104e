"""Samples, exposures and experiments."""

from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from pyrofit.data.noise import FloatArray, autoregressive, lowest_density, moving_average
from pyrofit.errors import suggest
from pyrofit.model.base import (
    NOT_NEGATIVE,
    POSITIVE,
    Fraction,
    NotNegative,
    Number,
    Part,
    Positive,
    Temperature,
    Thickness,
)

AboveZero = Annotated[float, Field(gt=0.0)]

TIMING_S = 0.5
"""Error of the clocks [s]: a tenth of the usual 5-s bins."""


class FluxTable(Part):
    """q_ext(t), linear between given points; two equal times are a step."""

    time_s: tuple[float, ...] = Field(description="times [s], not decreasing, from 0")
    flux_W_m2: Annotated[tuple[Number, ...], NOT_NEGATIVE] = Field(
        description="flux at those times [W/m2]"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        if len(self.time_s) != len(self.flux_W_m2) or not self.time_s:
            raise ValueError("time_s and flux_W_m2 need the same length, at least 1")
        if self.time_s[0] != 0.0:
            raise ValueError("time_s must start at 0")
        if any(b < a for a, b in zip(self.time_s, self.time_s[1:], strict=False)):
            raise ValueError("time_s must not decrease")
        return self


class Side(Part):
    """Heat exchange of one side with its surroundings."""

    h_W_m2K: NotNegative = Field(0.0, description="heat transfer coefficient [W/(m2 K)]")
    h_change_W_m2K: Number = Field(
        0.0,
        description="added to the heat transfer coefficient; the sum is at least 0 [W/(m2 K)]",
    )
    h_cube_root_W_m2K43: NotNegative = Field(
        0.0, description="C of an additional h = C |T - T_gas|^(1/3) [W/(m2 K^(4/3))]"
    )
    gas_temperature_K: Temperature = Field(293.15, description="gas temperature for convection [K]")
    gas_rise_K: Number = Field(0.0, description="rise of the gas temperature from t = 0 on [K]")
    gas_rise_time_s: NotNegative = Field(
        0.0, description="time constant of that rise [s]; 0 = at once"
    )
    wall_temperature_K: Temperature = Field(
        293.15, description="temperature of the radiating surroundings [K]"
    )


class Front(Side):
    """The irradiated side."""

    flux_W_m2: Annotated[Number | FluxTable, NOT_NEGATIVE] = Field(
        description="external radiant flux [W/m2]"
    )
    rise_time_s: NotNegative = Field(
        0.0, description="time constant with which the heater comes up from t = 0 on [s]"
    )
    spread: Fraction = Field(
        0.0, description="the flux varies over the surface, evenly within 1 -+ spread times q [-]"
    )
    drift_1_s: Number = Field(
        0.0, description="relative change of the flux per second; it stays at least 0 [1/s]"
    )
    drift_time_s: NotNegative = Field(
        0.0, description="time constant with which the drift comes to an end [s]; 0 = never"
    )


class Back(Side):
    """The other side."""

    emissivity: Fraction = Field(0.0, description="emissivity of the back face or foil [-]")
    loss_factor: NotNegative = Field(
        1.0, description="multiplies convection and radiation of the back [-]"
    )


class Foil(Part):
    """A thin, well conducting foil on the back: a lumped heat capacity."""

    thickness_m: Thickness = Field(description="thickness [m]")
    density_kg_m3: Positive = Field(description="density [kg/m3]")
    specific_heat_J_kgK: Positive = Field(description="specific heat capacity [J/(kg K)]")
    mass_factor: NotNegative = Field(1.0, description="multiplies the mass [-]")
    contact_m2K_W: NotNegative = Field(
        0.0, description="thermal resistance between sample and foil [m2 K/W]"
    )


class Edge(Part):
    """Heat exchange of the sample's edge with the gas beside it, for every depth alike."""

    h_W_m2K: NotNegative = Field(description="heat transfer coefficient [W/(m2 K)]")
    perimeter_per_area_1_m: Positive = Field(description="perimeter over area [1/m]")
    gas_temperature_K: Temperature = Field(293.15, description="gas temperature [K]")


class Layer(Part):
    """A layer of the sample, front first."""

    thickness_m: Thickness = Field(description="initial thickness [m]")
    composition: dict[str, float | str] | None = Field(
        None, description="mass fractions, where they differ from the material's"
    )


class EmissivityDepth(Part):
    """Depth over which residue is averaged for the surface emissivity.

    As FDS's surface cell: delta = cell_size_factor sqrt(k/(rho c) 1 s).
    """

    cell_size_factor: Positive = Field(description="CELL_SIZE_FACTOR of the FDS run [-]")


class Sample(Part):
    """The specimen of a gasification experiment."""

    layers: tuple[Layer, ...] = Field(min_length=1, description="layers, front first")
    foil: Foil | None = Field(None, description="foil on the back")
    emissivity_depth: Annotated[Number | EmissivityDepth, POSITIVE] = Field(
        1e-5, description="depth [m] over which the surface emissivity is averaged by volume"
    )
    initial_temperature_K: Temperature = Field(293.15, description="initial temperature [K]")
    thickness_factor: Positive = Field(
        1.0, description="multiplies the thickness of every layer [-]"
    )
    emissivity_change: Number = Field(
        0.0,
        description="added to the surface emissivity, times the mass released over the initial [-]",
    )
    absorption_length_m: NotNegative = Field(
        0.0, description="1/absorption_1_m of all components, instead of theirs [m]; 0 = theirs"
    )
    transmitted: Literal["foil", "lost"] = Field(
        "foil", description="radiation that passes the sample: the foil absorbs it, or it is lost"
    )
    edge: Edge | None = Field(None, description="heat exchange of the edge")


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
        "'synthetic' for a computed measurement"
    )
    columns: dict[str, str] = Field(
        default_factory=dict,
        description="header names of time, value, uncertainty, temperature where not recognised",
    )
    units: dict[str, str] = Field(
        default_factory=dict, description="units of these columns where the file has none"
    )
    uncertainty: AboveZero | None = Field(
        None, description="constant uncertainty, SI unit of the quantity"
    )
    uncertainty_meaning: str = Field("", description="what the uncertainty is, in words")
    uncertainty_sds: AboveZero = Field(
        1.0,
        description="standard deviations of a point's noise that the uncertainty is",
    )
    timing_s: float = Field(
        TIMING_S, ge=0.0, description="error of the clock [s]; it counts where the curve is steep"
    )
    average_s: float = Field(
        0.0, ge=0.0, description="width of the bins the values are averages over [s]; 0 = points"
    )
    delay_s: Number = Field(0.0, description="time by which the record is late [s]")
    offset: Number = Field(0.0, description="what the record shows too much, SI unit")
    sample_mass_kg: AboveZero | None = Field(None, description="initial sample mass [kg]")
    sample_area_m2: AboveZero | None = Field(None, description="exposed area [m2]")
    until_K: AboveZero | None = Field(
        None, description="TGA: use points below this temperature [K]"
    )
    until_s: AboveZero | None = Field(None, description="use points before this time [s]")
    noise: Annotated[Noise, BeforeValidator(_noise)] = Field(
        Noise(sd=0.0),
        description="synthetic: noise; a number is the standard deviation of white noise, SI unit",
    )
    every: AboveZero = Field(
        1.0, description="synthetic: spacing of the points [s], or [K] for TGA"
    )


class Experiment(Part):
    """What all experiments have."""

    QUANTITIES: ClassVar[tuple[str, ...]] = ()
    title: str = Field("", description="name in figures")
    signals: dict[str, Signal] = Field(description="measured quantities by name")

    @model_validator(mode="after")
    def _known_signals(self) -> Self:
        for name in self.signals:
            if name not in self.QUANTITIES:
                raise ValueError(f"unknown signal '{name}'. {suggest(name, self.QUANTITIES)}")
        return self


class Tga(Experiment):
    """Thermogravimetric analysis."""

    QUANTITIES: ClassVar[tuple[str, ...]] = ("mass_fraction",)
    kind: Literal["tga"] = Field(description="mass against temperature")
    heating_rate_K_min: AboveZero = Field(description="nominal heating rate [K/min]")
    program: Literal["nominal", "measured"] = Field(
        "measured", description="temperature over time: the measured one, or T0 + rate t"
    )
    lag_s: Number = Field(
        0.0, description="time by which the sample's temperature lags behind the program's [s]"
    )
    start_temperature_K: AboveZero = Field(300.0, description="synthetic: first temperature [K]")
    end_temperature_K: AboveZero = Field(850.0, description="synthetic: last temperature [K]")

    @model_validator(mode="after")
    def _lag_instead_of_delay(self) -> Self:
        for name, signal in self.signals.items():
            if signal.delay_s != 0.0 or signal.offset != 0.0:
                raise ValueError(
                    f"signal '{name}' of a TGA experiment takes neither delay_s nor offset; "
                    "a sample behind its program has lag_s"
                )
        return self


class Gasification(Experiment):
    """Mass loss of a slab under radiant heat in an inert atmosphere."""

    QUANTITIES: ClassVar[tuple[str, ...]] = ("mlr", "back_temperature")
    kind: Literal["gasification"] = Field(description="a slab under radiant heat")
    sample: Sample = Field(description="the specimen")
    front: Front = Field(description="irradiated side")
    back: Back = Field(default_factory=Back, description="other side; default: insulated")
    duration_s: AboveZero = Field(1000.0, description="synthetic: length of the record [s]")


AnyExperiment = Annotated[Tga | Gasification, Field(discriminator="kind")]
