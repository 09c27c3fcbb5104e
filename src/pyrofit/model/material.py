"""Components, their properties, and the reactions between them."""

from collections.abc import Mapping
from typing import Annotated, Self

from pydantic import Field, model_validator

from pyrofit.errors import suggest
from pyrofit.model.base import (
    FRACTION,
    NOT_NEGATIVE,
    POSITIVE,
    Fraction,
    NotNegative,
    Number,
    Part,
    Positive,
)
from pyrofit.model.properties import Property

REST = "rest"
"""Mass fraction of the one component that makes up the remainder."""


class Component(Part):
    """One solid component."""

    density_kg_m3: Positive = Field(description="density of the pure component [kg/m3]")
    conductivity_W_mK: Property = Field(description="thermal conductivity [W/(m K)]")
    specific_heat_J_kgK: Property = Field(description="specific heat capacity [J/(kg K)]")
    expansion: Property = Field(
        1.0, description="volume over mass/density [-]; thickness and d/k grow with it"
    )
    emissivity: Fraction = Field(0.9, description="surface emissivity = absorptivity [-]")
    absorption_1_m: Annotated[Number | None, POSITIVE] = Field(
        None, description="in-depth absorption coefficient [1/m]; none = opaque"
    )
    absorption_factor: Property = Field(
        1.0,
        description="multiplies the absorption coefficient, also that of absorption_length_m [-]",
    )


class Reaction(Part):
    """reactant -> products + gas, r = A exp(-E/(R T)) m0 u^n (1 + K (1 - u)) X^n_O2, u = m/m0.

    X is the volume fraction of oxygen.
    """

    reactant: str = Field(description="component that is consumed")
    products: Annotated[dict[str, Number], FRACTION] = Field(
        default_factory=dict, description="solid yields [kg per kg of reactant]; the rest is gas"
    )
    E_J_mol: NotNegative = Field(description="activation energy E [J/mol]")
    A_1_s: Annotated[Number | None, POSITIVE] = Field(
        None, description="pre-exponential factor A [1/s]"
    )
    reference_temperature_K: Annotated[Number | None, POSITIVE] = Field(
        None, description="temperature at which k is the reference rate, instead of A [K]"
    )
    reference_rate_1_s: Annotated[Number | None, NOT_NEGATIVE] = Field(
        None, description="k at that temperature [1/s]"
    )
    order: NotNegative = Field(1.0, description="reaction order n [-]")
    catalysis: NotNegative = Field(
        0.0,
        description="factor K of autocatalysis: the rate has the factor 1 + K (1 - m/m0) [-]; "
        "0 = none",
    )
    oxygen_order: NotNegative = Field(
        0.0,
        description="exponent n_O2 of the volume fraction of oxygen, a factor of the rate [-]; "
        "0 = the reaction needs no oxygen",
    )
    oxygen_depth_m: Positive = Field(
        1e-3,
        description="slabs: depth L below the surface over which the volume fraction of oxygen "
        "falls to 1/e, exp(-x/L) [m]",
    )
    oxygen_use: NotNegative = Field(
        0.0,
        description="slabs: oxygen used up per kg of reactant, supplied by convection at the "
        "front; carbon to CO2: 2.67; 0 = never short [kg/kg]",
    )
    heat_of_reaction_J_kg: Number = Field(
        0.0, description="heat of reaction per kg of reactant [J/kg], positive = endothermic"
    )
    heat_of_combustion_J_kg: NotNegative = Field(
        0.0, description="heat of combustion of the gas it forms, per kg of gas [J/kg]"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        reference = (self.reference_temperature_K is None, self.reference_rate_1_s is None)
        if self.A_1_s is None and any(reference):
            raise ValueError("give A_1_s, or reference_temperature_K with reference_rate_1_s")
        if self.A_1_s is not None and not all(reference):
            raise ValueError("give either A_1_s or the reference pair, not both")
        total = sum(nu for nu in self.products.values() if isinstance(nu, float))
        if total > 1.0 + 1e-12:
            raise ValueError(f"the solid yields add up to {total:g}, above 1")
        return self


class Material(Part):
    """Components, reactions and the composition of the virgin material."""

    components: dict[str, Component] = Field(description="solid components by name")
    reactions: dict[str, Reaction] = Field(default_factory=dict, description="reactions by name")
    composition: dict[str, float | str] = Field(
        description="mass fractions of the virgin material; one may be 'rest'"
    )

    @model_validator(mode="after")
    def _check(self) -> Self:
        if self.components or self.composition:  # else external programs have their own
            check_composition(self.composition, self.components)
        for name, reaction in self.reactions.items():
            for used in (reaction.reactant, *reaction.products):
                if used not in self.components:
                    raise ValueError(
                        f"reaction '{name}' uses the unknown component '{used}'. "
                        + suggest(used, self.components)
                    )
            if reaction.reactant in reaction.products:
                raise ValueError(
                    f"reaction '{name}' forms its own reactant '{reaction.reactant}'; take it out"
                )
        opaque = {self.components[name].absorption_1_m is None for name in self.own}
        if len(opaque) == 2:
            raise ValueError(
                "give absorption_1_m for every component or for none; boards and plates excepted"
            )
        self.reaction_order()
        return self

    @property
    def own(self) -> frozenset[str]:
        """Components that the virgin material has, or that react or are formed.

        The remaining ones are inert bodies of experiments: boards, plates, gaps.
        """
        of_reactions = {n for r in self.reactions.values() for n in (r.reactant, *r.products)}
        return frozenset({*self.composition, *of_reactions})

    @property
    def oxidises(self) -> bool:
        """Whether the rate of a reaction depends on oxygen."""
        return self.derived(
            "oxidises", lambda m: any(r.oxygen_order != 0.0 for r in m.reactions.values())
        )

    def without_bodies_but(self, bodies: frozenset[str]) -> Self:
        """Return the material without the inert components that are not among some bodies."""
        wanted = self.own | bodies
        kept = {name: of for name, of in self.components.items() if name in wanted}
        if len(kept) == len(self.components):
            return self
        return self.model_copy(update={"components": kept})

    def reaction_order(self) -> tuple[str, ...]:
        """Return the reactions sorted so that products react after they are formed.

        Raises
        ------
        ValueError
            If reactions form a cycle.
        """
        done: list[str] = []
        waiting = list(dict.fromkeys(r.reactant for r in self.reactions.values()))
        while waiting:
            for reactant in waiting:
                producers = {r.reactant for r in self.reactions.values() if reactant in r.products}
                if not producers & set(waiting):
                    break
            else:
                raise ValueError(
                    f"the reactions of {', '.join(waiting)} form a cycle; take one out"
                )
            waiting.remove(reactant)
            done += [n for n, r in self.reactions.items() if r.reactant == reactant]
        return tuple(done)


def check_composition(
    composition: Mapping[str, float | str], components: dict[str, Component]
) -> None:
    """Refuse mass fractions that cannot add up to one."""
    for name, fraction in composition.items():
        if name not in components:
            raise ValueError(f"unknown component '{name}'. " + suggest(name, components))
        if isinstance(fraction, float) and not 0.0 <= fraction <= 1.0:
            raise ValueError(f"the mass fraction of '{name}' is {fraction:g}, not within 0 and 1")
    rests = sum(fraction == REST for fraction in composition.values())
    if rests > 1:
        raise ValueError("only one component may be 'rest'")
    numbers = [f for f in composition.values() if isinstance(f, float)]
    if rests == 0:
        if len(numbers) < len(composition):
            raise ValueError("where a fraction is a parameter, one component must be 'rest'")
        if abs(sum(numbers) - 1.0) > 1e-9:
            raise ValueError(f"the mass fractions add up to {sum(numbers):g}, not to 1")
    elif sum(numbers) > 1.0:
        raise ValueError(f"the mass fractions add up to {sum(numbers):g}, above 1")
