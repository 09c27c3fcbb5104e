"""Which parameters parts of a description use."""

from collections.abc import Mapping

from pyrofit.model.base import numbers
from pyrofit.model.material import REST, Material
from pyrofit.model.slab import SlabExperiment


def parameters_in(*parts: object) -> set[str]:
    """Return the names of the parameters that parts of a description use."""
    found = set()
    for part in parts:
        found |= {value for _, value, _ in numbers(part) if isinstance(value, str)}
        if isinstance(part, Material):
            found |= names_in(part.composition)
        if isinstance(part, SlabExperiment):
            for layer in part.sample.layers:
                found |= names_in(layer.composition or {})
    return found


def parameters_of_tga(material: Material) -> set[str]:
    """Return the names of the parameters that the kinetics and the composition use."""
    cold = {"heat_of_reaction_J_kg": 0.0}
    kinetics = [reaction.model_copy(update=cold) for reaction in material.reactions.values()]
    return parameters_in(*kinetics) | names_in(material.composition)


def names_in(composition: Mapping[str, float | str]) -> set[str]:
    """Return the names of the parameters among mass fractions."""
    return {f for f in composition.values() if isinstance(f, str) and f != REST}
