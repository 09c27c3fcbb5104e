"""Part of the main reactant turns into an intermediate that reacts on."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity, reacts
from pyrofit.effects.substance import (
    REFERENCE_RATE_1_S,
    main_reaction,
    with_component,
    with_main,
    with_reaction,
)
from pyrofit.model.material import Material, Reaction

INTERMEDIATE = f"{ADDED}intermediate"


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    more = with_component(material, INTERMEDIATE, material.components[reaction.reactant])
    more = with_main(more, products={**reaction.products, INTERMEDIATE: at["yield"]})
    second = Reaction(
        reactant=INTERMEDIATE,
        E_J_mol=at["E_J_mol"],
        reference_temperature_K=at["temperature_K"],
        reference_rate_1_s=REFERENCE_RATE_1_S,
        heat_of_combustion_J_kg=reaction.heat_of_combustion_J_kg,
    )
    return with_reaction(more, INTERMEDIATE, second)


EFFECT = Effect(
    title="consecutive reaction",
    family="material",
    group="reactions",
    equation="main reactant -> its products + y intermediate; intermediate -> gas, "
    "k(T_i) = 0.001 1/s, E_i, no heat",
    strength={
        "yield": Quantity(
            symbol="y",
            label="yield of the intermediate",
            unit="-",
            lower=0.0,
            upper=0.5,
            value=0.0,
            typical=0.1,
            source="assumed range; MaCFP PMMA: groups use 1 to 3 reactions, in series or parallel",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_i",
            label="temperature at which the intermediate reacts at 0.001 1/s",
            unit="K",
            lower=500.0,
            upper=750.0,
            value=640.0,
            typical=620.0,
        ),
        "E_J_mol": Quantity(
            symbol="E_i",
            label="activation energy of the intermediate",
            unit="J/mol",
            lower=5e4,
            upper=3e5,
            value=1.6e5,
            typical=1.0e5,
        ),
    },
    material=_change,
    needs=reacts,
)
