"""The sample is glued to the body behind it, by a layer that decomposes as well."""

from pyrofit.effects.base import ADDED, Effect, Numbers, Quantity, changed
from pyrofit.effects.substance import (
    REFERENCE_RATE_1_S,
    main_reaction,
    with_component,
    with_reaction,
)
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material, Reaction
from pyrofit.model.slab import Adhesive, SlabExperiment

GLUE = f"{ADDED}adhesive"
DENSITY_KG_M3, CONDUCTIVITY_W_MK, ENERGY_J_MOL = 1150.0, 0.2, 1.8e5
"""Of cured epoxy resin; a layer this thin shows its mass and the temperature of its release."""


def _change(material: Material, at: Numbers) -> Material:
    _, reaction = main_reaction(material)
    glue = changed(
        material.components[reaction.reactant],
        density_kg_m3=DENSITY_KG_M3,
        conductivity_W_mK=CONDUCTIVITY_W_MK,
        specific_heat_J_kgK=at["specific_heat_J_kgK"],
        expansion=1.0,
    )
    decomposition = Reaction(
        reactant=GLUE,
        E_J_mol=ENERGY_J_MOL,
        reference_temperature_K=at["temperature_K"],
        reference_rate_1_s=REFERENCE_RATE_1_S,
        # ASSUME: it takes as much heat as the decomposition of the same mass of the material.
        heat_of_reaction_J_kg=reaction.heat_of_reaction_J_kg,
        heat_of_combustion_J_kg=reaction.heat_of_combustion_J_kg,
    )
    return with_reaction(with_component(material, GLUE, glue), GLUE, decomposition)


def _glued(experiment: Experiment, at: Numbers) -> Experiment:
    assert isinstance(experiment, SlabExperiment)
    if experiment.sample.adhesive is not None:
        raise ValueError("the sample has an adhesive already")
    glue = Adhesive(thickness_m=at["thickness_m"], component=GLUE)
    return changed(experiment, sample=changed(experiment.sample, adhesive=glue))


EFFECT = Effect(
    title="adhesive behind the sample",
    family="apparatus",
    group="adhesive",
    equation="layer of thickness d, 1150 kg/m3, 0.2 W/(m K), c_a -> gas, k(T_a) = 0.001 1/s, "
    "180 kJ/mol",
    strength={
        "thickness_m": Quantity(
            symbol="d",
            label="thickness of the adhesive",
            unit="m",
            lower=0.0,
            upper=1e-3,
            value=0.0,
            typical=1e-4,
            plausible=(0.0, 0.0003),
            source="assumed range; MaCFP PMMA: samples are glued with epoxy, which UMD's model "
            "counts as PMMA",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_a",
            label="temperature at which the adhesive decomposes at 0.001 1/s",
            unit="K",
            lower=500.0,
            upper=850.0,
            value=630.0,
            typical=680.0,
            source="assumed range; cured epoxy resins lose mass fastest at 620 to 700 K",
        ),
        "specific_heat_J_kgK": Quantity(
            symbol="c_a",
            label="specific heat of the adhesive",
            unit="J/(kg K)",
            lower=1000.0,
            upper=3000.0,
            value=2000.0,
            typical=1500.0,
        ),
    },
    material=_change,
    experiment=_glued,
    of_sample=True,
)
