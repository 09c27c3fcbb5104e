"""A slab under radiant heat: sample, sides, foil, edge."""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from pyrofit.errors import suggest
from pyrofit.model.base import (
    NOT_NEGATIVE,
    POSITIVE,
    THIN,
    AboveZero,
    Fraction,
    NotNegative,
    Number,
    Part,
    Positive,
    Temperature,
    Thickness,
)
from pyrofit.model.experiment import Experiment
from pyrofit.model.time_table import CoefficientOverTime, FluxOverTime, TemperatureOverTime


class Side(Part):
    """Heat exchange of one side with its surroundings."""

    h_W_m2K: CoefficientOverTime = Field(
        0.0, description="heat transfer coefficient, may follow a table over time [W/(m2 K)]"
    )
    h_change_W_m2K: Number = Field(
        0.0,
        description="added to the heat transfer coefficient, at every time of its table; the sum "
        "is at least 0 [W/(m2 K)]",
    )
    h_cube_root_W_m2K43: NotNegative = Field(
        0.0, description="C of an additional h = C |T - T_gas|^(1/3) [W/(m2 K^(4/3))]"
    )
    gas_temperature_K: TemperatureOverTime = Field(
        293.15, description="gas temperature for convection, may follow a table over time [K]"
    )
    gas_rise_K: Number = Field(0.0, description="rise of the gas temperature from t = 0 on [K]")
    gas_rise_time_s: NotNegative = Field(
        0.0, description="time constant of that rise [s]; 0 = at once"
    )
    wall_temperature_K: TemperatureOverTime = Field(
        293.15,
        description="temperature of the radiating surroundings, may follow a table over time [K]",
    )


class FluxProfile(Part):
    """The flux over the radius of a round sample, linear between given points."""

    radius_m: tuple[float, ...] = Field(description="increasing radii [m], from 0 to the edge")
    relative_flux: tuple[float, ...] = Field(description="flux there over the one of the front [-]")

    @model_validator(mode="after")
    def _check(self) -> Self:
        given = len(self.radius_m), len(self.relative_flux)
        if given[0] != given[1] or given[0] < 2:
            raise ValueError(
                "radius_m and relative_flux need the same length, at least 2; they have "
                f"{given[0]} and {given[1]}: add or delete points"
            )
        if self.radius_m[0] != 0.0:
            raise ValueError("radius_m must start at 0, the middle; add a point there")
        if any(b <= a for a, b in zip(self.radius_m, self.radius_m[1:], strict=False)):
            raise ValueError("radius_m must increase; sort the points by radius")
        if min(self.relative_flux) < 0.0:
            raise ValueError("relative_flux must not be negative; correct it")
        return self


class Front(Side):
    """The irradiated side."""

    flux_W_m2: FluxOverTime = Field(
        description="external radiant flux, may follow a table over time [W/m2]"
    )
    flux_factor: NotNegative = Field(1.0, description="multiplies the external radiant flux [-]")
    rise_time_s: NotNegative = Field(
        0.0, description="time constant with which the heater comes up from t = 0 on [s]"
    )
    spread: Fraction = Field(
        0.0, description="the flux varies over the surface, evenly within 1 -+ spread times q [-]"
    )
    profile: FluxProfile | None = Field(
        None, description="flux over the radius of a round sample; none = the same everywhere"
    )
    drift_1_s: Number = Field(
        0.0, description="relative change of the flux per second; it stays at least 0 [1/s]"
    )
    drift_time_s: NotNegative = Field(
        0.0, description="time constant with which the drift comes to an end [s]; 0 = never"
    )


class Flame(Part):
    """The flame of a burning sample, from ignition to flame-out."""

    flux_W_m2: NotNegative = Field(
        0.0, description="constant heat flux of the flame, added to the external flux [W/m2]"
    )
    ignition_s: NotNegative = Field(0.0, description="time of ignition [s]; before, no gas burns")
    ends_s: NotNegative | None = Field(
        None, description="time of flame-out [s]; none = burns to the end"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        begins, ends = self.ignition_s, self.ends_s
        if isinstance(begins, float) and isinstance(ends, float) and ends <= begins:
            raise ValueError(
                f"ends_s {ends:g} must be later than ignition_s {begins:g}; leave it out where the "
                "flame lasts to the end"
            )
        return self


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


class Adhesive(Part):
    """A thin layer between sample and backing or foil; it counts as part of the sample."""

    thickness_m: Annotated[Number, NOT_NEGATIVE, THIN] = Field(
        description="thickness [m]; 0 = there is none"
    )
    component: str = Field(description="component that it consists of; it may react")


class Backing(Part):
    """An inert layer behind the sample: board, plate or gap."""

    thickness_m: Thickness = Field(description="thickness [m]")
    component: str = Field(description="component that it consists of; it must not react")


class EmissivityDepth(Part):
    """Depth over which residue is averaged for the surface emissivity.

    As FDS's surface cell: delta = cell_size_factor sqrt(k/(rho c) 1 s).
    """

    cell_size_factor: Positive = Field(description="CELL_SIZE_FACTOR of the FDS run [-]")


class Sample(Part):
    """The specimen: layers, foil, edge."""

    layers: tuple[Layer, ...] = Field(min_length=1, description="layers, front first")
    adhesive: Adhesive | None = Field(
        None, description="layer of glue behind the layers; thickness_factor spares it"
    )
    backing: tuple[Backing, ...] = Field(
        (),
        description="inert layers behind the sample, front first; keys of the sample spare them",
    )
    foil: Foil | None = Field(None, description="foil on the back, behind the backing")
    emissivity_depth: Annotated[Number | EmissivityDepth, POSITIVE] = Field(
        1e-5, description="depth [m] over which the surface emissivity is averaged by volume"
    )
    initial_temperature_K: Temperature = Field(293.15, description="initial temperature [K]")
    thickness_factor: Positive = Field(
        1.0, description="multiplies the thickness of every layer, not of the backing [-]"
    )
    emissivity_change: Number = Field(
        0.0,
        description="added to the surface emissivity, times the mass released over the initial [-]",
    )
    absorption_length_m: NotNegative = Field(
        0.0,
        description="1/absorption_1_m of all components of the material, instead of theirs [m]; "
        "0 = theirs",
    )
    surface_share: Fraction = Field(
        0.0,
        description="share of the radiation that a translucent sample absorbs at its surface; the "
        "rest in depth [-]",
    )
    gas_specific_heat_J_kgK: NotNegative = Field(
        0.0,
        description="specific heat of the gas, which is heated on its way to the front; 0 = it "
        "takes no heat with it [J/(kg K)]",
    )
    transmitted: Literal["foil", "back", "lost"] = Field(
        "foil",
        description="radiation that passes the sample: the foil absorbs it; the back face, with or "
        "without a foil; or it is lost",
    )
    edge: Edge | None = Field(None, description="heat exchange of the edge")

    @property
    def back_absorbs(self) -> bool:
        """Whether radiation that passes the sample heats its back, or the foil there."""
        return self.transmitted == "back" or (self.transmitted == "foil" and self.foil is not None)


class SlabExperiment(Experiment):
    """A slab under radiant heat."""

    APPARATUS: ClassVar[str] = "slab"
    """Its name in words."""
    sample: Sample = Field(description="the specimen")
    front: Front = Field(description="irradiated side")
    back: Back = Field(default_factory=Back, description="other side; default: insulated")
    duration_s: AboveZero = Field(
        1000.0, description="synthetic or predicted: length of the record [s]"
    )
    predicts: tuple[str, ...] = Field(
        (), description="quantities that are predicted for it without a measurement"
    )

    @model_validator(mode="after")
    def _known_predictions(self) -> Self:
        known = {name: q for name, q in self.measurable.items() if q.place == "fixed"}
        for name in self.predicts:
            if name not in known:
                raise ValueError(f"predicts: unknown quantity '{name}'. {suggest(name, known)}")
        return self

    @property
    def synthetic_span(self) -> tuple[float, str]:
        """Length of a computed record [s], and the keys that set it."""
        return self.duration_s, "duration_s"

    def burning(self) -> Flame | None:
        """Return the flame; without one, what gas is released burns at once."""
        return None
