"""The main reaction leaves char, of which the model has none or too little."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity, changed, reacts
from pyrofit.effects.substance import main_reaction, with_component, with_main
from pyrofit.model.material import Material

CHAR = f"{ADDED}char"


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    char = changed(
        material.components[reaction.reactant],
        density_kg_m3=at["density_kg_m3"],
        conductivity_W_mK=at["conductivity_W_mK"],
    )
    with_char = with_component(material, CHAR, char)
    return with_main(with_char, products={**reaction.products, CHAR: at["yield"]})


EFFECT = Effect(
    title="char layer",
    family="material",
    group="residue",
    equation="main reactant -> its products + y char of rho_c and k_c; c and eps as the reactant's",
    strength={
        "yield": Quantity(
            symbol="y",
            label="char yield of the main reaction",
            unit="-",
            lower=0.0,
            upper=0.3,
            value=0.0,
            typical=0.03,
            source="assumed range; PMMA none, charring polymers more",
        )
    },
    form={
        "density_kg_m3": Quantity(
            symbol="rho_c",
            label="density of the char",
            unit="kg/m3",
            lower=50.0,
            upper=1000.0,
            value=300.0,
            typical=150.0,
        ),
        "conductivity_W_mK": Quantity(
            symbol="k_c",
            label="conductivity of the char",
            unit="W/(m K)",
            lower=0.03,
            upper=1.0,
            value=0.2,
            typical=0.1,
        ),
    },
    material=_change,
    needs=reacts,
)
