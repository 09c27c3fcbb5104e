"""A slab under radiant heat: sample, sides, foil, edge."""

from collections.abc import Mapping
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
from pyrofit.model.material import REST
from pyrofit.model.slab_faces import Back, Flame, Front


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
    beside: dict[str, float | str] = Field(
        default_factory=dict,
        description="mass fractions of components beside the material, such as water",
    )

    @model_validator(mode="after")
    def _either(self) -> Self:
        if self.composition is not None and self.beside:
            raise ValueError("give `composition` or `beside`, not both")
        if REST in self.beside.values():
            raise ValueError("`beside`: the rest is the material; give each component its share")
        return self

    def composed(self, material: Mapping[str, float | str]) -> Mapping[str, float | str]:
        """Return the mass fractions of the layer, from those of the material.

        w_i = (1 - sum of those beside it) w_i of the material.

        >>> layer = Layer(thickness_m=0.01, beside={"water": "w"})
        >>> layer.composed({"early": 0.2, "main": "rest"})
        {'early': '(0.2) * (1 - w)', 'main': 'rest', 'water': 'w'}
        """
        if self.composition is not None:
            return self.composition
        if not self.beside:
            return material
        left = " - ".join(["1", *(f"{share}" for share in self.beside.values())])
        rest = next((n for n, w in material.items() if w == REST), next(iter(material), ""))
        own = {n: REST if n == rest else f"({w}) * ({left})" for n, w in material.items()}
        return {**own, **self.beside}


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
    density_factor: Positive = Field(
        1.0,
        description="multiplies density and conductivity of the material's components, not of "
        "boards and foil: a denser piece of a porous material, of the same diffusivity [-]",
    )
    conductivity_factor: Positive = Field(
        1.0,
        description="multiplies the conductivity of the material's components, not of boards and "
        "foil: a piece cut in another direction of the grain [-]",
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
    def bodies(self) -> frozenset[str]:
        """Components that layers with a composition of their own, adhesive and backing have."""
        return self.derived("bodies", Sample._bodies)

    def _bodies(self) -> frozenset[str]:
        parts = (*self.backing, *([self.adhesive] if self.adhesive else ()))
        of_layers = {name for layer in self.layers for name in layer.composition or layer.beside}
        return frozenset({*of_layers, *(part.component for part in parts)})

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
    oxygen: Fraction = Field(
        0.0,
        description="volume fraction of oxygen at the front, while no flame keeps it away [-]; "
        "air: 0.209",
    )
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

    @property
    def jumps(self) -> bool:
        """Rates jump at ignition; rates and back temperatures bend sharply at the burn-out."""
        return True

    def burning(self) -> Flame | None:
        """Return the flame; without one, released gas burns at once."""
        return None
