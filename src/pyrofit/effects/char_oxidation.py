"""The residue of the main reaction burns where oxygen reaches it."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity, has_oxygen
from pyrofit.effects.substance import main_reaction, with_reaction
from pyrofit.model.material import Material, Reaction

REFERENCE_TEMPERATURE_K = 700.0
"""Temperature of the rate that is the strength; another one would only scale that."""
CARBON_OXYGEN = 2.67
"""Oxygen that carbon uses up as it burns to CO2 [kg/kg]."""


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    if not reaction.products:
        raise ValueError("the main reaction leaves no residue that burns; give it a product")
    burns = Reaction(
        reactant=next(iter(reaction.products)),
        E_J_mol=at["E_J_mol"],
        reference_temperature_K=REFERENCE_TEMPERATURE_K,
        reference_rate_1_s=at["rate_1_s"],
        oxygen_order=1.0,
        oxygen_use=CARBON_OXYGEN,
        heat_of_reaction_J_kg=at["heat_J_kg"],
    )
    return with_reaction(material, f"{ADDED}oxidation", burns)


EFFECT = Effect(
    title="char oxidation",
    family="material",
    group="oxidation",
    equation="residue of the main reaction -> gas, r = k m X exp(-x/(1 mm)), X oxygen at the "
    "surface. Constants: k(700 K) = k_700, E_o, heat dh_o; 2.67 kg of oxygen per kg of residue, "
    "which convection supplies to a slab. Small samples have x = 0",
    strength={
        "rate_1_s": Quantity(
            symbol="k_700",
            label="rate constant of the oxidation at 700 K in pure oxygen",
            unit="1/s",
            lower=0.0,
            upper=5e-3,
            value=0.0,
            typical=2e-3,
            source="assumed range; in air a fifth of it acts",
        )
    },
    form={
        "E_J_mol": Quantity(
            symbol="E_o",
            label="activation energy of the oxidation",
            unit="J/mol",
            lower=4e4,
            upper=1.4e5,
            value=1e5,
            typical=7e4,
        ),
        "heat_J_kg": Quantity(
            symbol="dh_o",
            label="heat of the oxidation, negative = released",
            unit="J/kg",
            lower=-3.3e7,
            upper=0.0,
            value=-5e6,
            typical=-2e6,
            source="assumed range; that of carbon is -33 MJ/kg",
        ),
    },
    material=_change,
    needs=has_oxygen,
)
