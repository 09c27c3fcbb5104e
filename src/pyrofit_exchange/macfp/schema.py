"""The strict form of a parameter set: pyrofit writes it, and others may rely on it."""

import json
from typing import Annotated, Any, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from pyrofit_exchange.macfp.forms import (
    Line,
    Lines,
    Nothing,
    PerComponent,
    PerReaction,
    Power,
    Single,
    Table,
)

OfMaterial = Annotated[
    Single | Table | Line | Lines | Power | Nothing | PerComponent, Field(discriminator="form")
]
OfReactions = Annotated[Single | Nothing | PerReaction, Field(discriminator="form")]
TOLERANCE = 1e-6


class Strict(BaseModel):
    """A part of a parameter set."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)


class Calibration(Strict):
    """How a group of parameters was found."""

    model: str | None = Field(None, alias="Model", description="program and version")
    method: str = Field(alias="Method", description="method of calibration or measurement")
    scope: tuple[str, ...] = Field(alias="Scope", description="parameters that were found")
    data: dict[str, Any] = Field(default_factory=dict, alias="Data", description="data used")
    note: str | None = Field(None, alias="Note", description="anything else")


class Composition(Strict):
    """Components and their mass fractions in the virgin material."""

    count: int = Field(alias="Number of Components", ge=1)
    names: tuple[str, ...] = Field(alias="Component Names")
    fractions: tuple[float, ...] = Field(alias="Initial Mass Fraction", description="[-]")


class Kinetics(Strict):
    """Reactions; components count from 1, and 0 is gas."""

    reactants: tuple[tuple[int], ...] = Field(alias="Reactants")
    products: tuple[tuple[int, ...], ...] = Field(
        alias="Products", description="the first takes the solid yield; 0 = gas alone"
    )
    A: tuple[float, ...] = Field(alias="Pre-exponential", description="[1/s]")
    E: tuple[float, ...] = Field(alias="Activation Energy", description="[J/mol]")
    order: tuple[float, ...] = Field(alias="Reaction Order", description="[-]")
    yields: tuple[float, ...] = Field(
        alias="Solid Yield", description="kg of solid product per kg of reactant"
    )


class Thermodynamics(Strict):
    """Thermodynamic properties."""

    heat_capacity: OfMaterial = Field(alias="Heat Capacity", description="[J/(kg K)]")
    heat_of_pyrolysis: OfReactions = Field(
        alias="Heat of Pyrolysis", description="[J/kg of reactant], positive = endothermic"
    )
    density: OfMaterial = Field(alias="Density", description="[kg/m3]")


class Combustion(Strict):
    """Combustion of the gases."""

    heat: OfReactions = Field(alias="Heat of Combustion", description="[J/kg of gas]")


class Transport(Strict):
    """Transport properties."""

    conductivity: OfMaterial = Field(alias="Conductivity", description="[W/(m K)]")
    absorption: OfMaterial = Field(
        alias="Absorption", description="in depth [1/m]; Form None = absorbed at the surface"
    )
    emissivity: OfMaterial = Field(alias="Emissivity", description="[-]")


class StrictSet(Strict):
    """A parameter set of the MaCFP data base."""

    material: str = Field(alias="Material")
    laboratory: str = Field(alias="Lab")
    calibration: tuple[Calibration, ...] = Field(alias="Calibration")
    composition: Composition = Field(alias="Composition")
    kinetics: Kinetics = Field(alias="Kinetics")
    thermodynamics: Thermodynamics | None = Field(None, alias="Thermodynamics")
    combustion: Combustion | None = Field(None, alias="Combustion")
    transport: Transport | None = Field(None, alias="Transport")

    @model_validator(mode="after")
    def _check(self) -> Self:
        count, k = self.composition.count, self.kinetics
        for key, given in (
            ("Component Names", self.composition.names),
            ("Initial Mass Fraction", self.composition.fractions),
        ):
            if len(given) != count:
                raise ValueError(f"{key} has {len(given)} entries for {count} components")
        if abs(sum(self.composition.fractions) - 1.0) > TOLERANCE:
            raise ValueError(f"Initial Mass Fraction adds up to {sum(self.composition.fractions)}")
        lengths = {len(x) for x in (k.reactants, k.products, k.A, k.E, k.order, k.yields)}
        if len(lengths) != 1:
            raise ValueError(f"the lists of Kinetics have different lengths: {sorted(lengths)}")
        used = [i for one in (*k.reactants, *k.products) for i in one]
        if not all(0 <= i <= count for i in used) or any(r[0] == 0 for r in k.reactants):
            raise ValueError(f"Reactants and Products must lie within 1 and {count}; 0 = gas")
        if not all(0.0 <= nu <= 1.0 for nu in k.yields):
            raise ValueError("Solid Yield must lie within 0 and 1")
        if any(nu > 0.0 and p[0] == 0 for nu, p in zip(k.yields, k.products, strict=True)):
            raise ValueError("a Solid Yield above 0 needs a component among Products")
        return self

    def as_json(self) -> dict[str, Any]:
        """Return the set as data for JSON."""
        given = self.model_dump(mode="json", by_alias=True, exclude_none=True)
        return dict(given)

    def text(self) -> str:
        """Return the set as the text of a file."""
        return json.dumps(self.as_json(), indent=2, ensure_ascii=False) + "\n"


def schema() -> dict[str, Any]:
    """Return the JSON Schema of the strict form."""
    found = StrictSet.model_json_schema(by_alias=True)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **found}
