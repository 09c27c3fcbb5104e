"""Moisture or monomer leaves the material before it decomposes."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity
from pyrofit.effects.substance import (
    REFERENCE_RATE_1_S,
    is_of_the_material,
    main_reaction,
    with_part,
)
from pyrofit.model.material import Material, Reaction

VOLATILE = f"{ADDED}volatile"


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    release = Reaction(
        reactant=VOLATILE,
        E_J_mol=at["E_J_mol"],
        reference_temperature_K=at["temperature_K"],
        reference_rate_1_s=REFERENCE_RATE_1_S,
        # ASSUME: its release takes as much heat as the decomposition of the same mass.
        heat_of_reaction_J_kg=reaction.heat_of_reaction_J_kg,
    )
    return with_part(material, VOLATILE, at["share"], release)


EFFECT = Effect(
    title="volatile",
    family="material",
    group="volatiles",
    equation="main component = (1 - w) itself + w volatile; volatile -> gas, "
    "k(T_v) = 0.001 1/s, E_v",
    strength={
        "share": Quantity(
            symbol="w",
            label="mass fraction of the volatile",
            unit="-",
            lower=0.0,
            upper=0.2,
            value=0.0,
            typical=0.015,
            source="assumed range; 0.003 to 0.02 is usual of dry polymers, "
            "wood in moist air holds up to 0.2 of water",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_v",
            label="temperature at which the volatile leaves at 0.001 1/s",
            unit="K",
            lower=310.0,
            upper=550.0,
            value=430.0,
            typical=470.0,
        ),
        "E_J_mol": Quantity(
            symbol="E_v",
            label="activation energy of the volatile",
            unit="J/mol",
            lower=3e4,
            upper=2e5,
            value=8e4,
            typical=1.2e5,
        ),
    },
    material=_change,
    needs=is_of_the_material,
)
