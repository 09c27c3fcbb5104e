"""A further reaction competes for the main reactant."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity, changed, reacts
from pyrofit.effects.substance import main_reaction, with_reaction
from pyrofit.model.material import Material

REFERENCE_TEMPERATURE_K = 600.0
"""Temperature of the rate that is the strength; another one would only scale that."""


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    further = changed(
        reaction,
        A_1_s=None,
        E_J_mol=at["E_J_mol"],
        reference_temperature_K=REFERENCE_TEMPERATURE_K,
        reference_rate_1_s=at["rate_1_s"],
    )
    return with_reaction(material, f"{ADDED}reaction", further)


EFFECT = Effect(
    title="competing reaction",
    family="material",
    group="reactions",
    equation="r = (k_main + k) m, k(600 K) = k_600, E_c; same products, same heat",
    strength={
        "rate_1_s": Quantity(
            symbol="k_600",
            label="rate constant of the competing reaction at 600 K",
            unit="1/s",
            lower=0.0,
            upper=5e-3,
            value=0.0,
            typical=3e-4,
            source="assumed range; MaCFP PMMA: groups use 1 to 3 reactions, in series or parallel",
        )
    },
    form={
        "E_J_mol": Quantity(
            symbol="E_c",
            label="activation energy of the competing reaction",
            unit="J/mol",
            lower=3e4,
            upper=3e5,
            value=8e4,
            typical=2.2e5,
        )
    },
    material=_change,
    needs=reacts,
)
