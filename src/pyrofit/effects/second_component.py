"""A part of the material is another component, which reacts at other temperatures."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity, changed
from pyrofit.effects.substance import (
    REFERENCE_RATE_1_S,
    is_of_the_material,
    main_reaction,
    with_part,
)
from pyrofit.model.material import Material

SECOND = f"{ADDED}component"


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    second = changed(
        reaction,
        reactant=SECOND,
        A_1_s=None,
        E_J_mol=at["E_J_mol"],
        reference_temperature_K=at["temperature_K"],
        reference_rate_1_s=REFERENCE_RATE_1_S,
    )
    return with_part(material, SECOND, at["share"], second)


EFFECT = Effect(
    title="second component",
    family="material",
    group="reactions",
    equation="main component = (1 - w) itself + w second one, k(T_2) = 0.001 1/s, E_2; "
    "same products, same heat",
    strength={
        "share": Quantity(
            symbol="w",
            label="mass fraction of the second component",
            unit="-",
            lower=0.0,
            upper=0.6,
            value=0.0,
            typical=0.3,
            source="assumed range; wood consists of three components of 0.2 to 0.5 each",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_2",
            label="temperature at which the second component reacts at 0.001 1/s",
            unit="K",
            lower=480.0,
            upper=750.0,
            value=640.0,
            typical=560.0,
        ),
        "E_J_mol": Quantity(
            symbol="E_2",
            label="activation energy of the second component",
            unit="J/mol",
            lower=5e4,
            upper=3e5,
            value=1.8e5,
            typical=1.4e5,
        ),
    },
    material=_change,
    needs=is_of_the_material,
)
