"""Which parameters parts of a description use."""

from collections.abc import Collection, Iterable, Mapping

from pyrofit.model.base import named_by, numbers
from pyrofit.model.external import ExternalExperiment
from pyrofit.model.material import REST, Material
from pyrofit.model.slab import SlabExperiment
from pyrofit.quantities.base import Quantity

HEATS = ("heat_of_reaction_J_kg", "heat_of_combustion_J_kg")
"""Keys of a reaction on which its rate does not depend."""


def parameters_in(*parts: object) -> set[str]:
    """Return the names of the parameters that parts of a description use."""
    found = set()
    for part in parts:
        found |= {name for _, value, _ in numbers(part) for name in named_by(value)}
        if isinstance(part, Material):
            found |= names_in(part.composition)
        if isinstance(part, ExternalExperiment):
            found |= set(part.program.units)
        if isinstance(part, SlabExperiment):
            for layer in part.sample.layers:
                found |= names_in(layer.composition or layer.beside)
    return found


def parameters_of_heated(material: Material, quantities: Iterable[Quantity] = ()) -> set[str]:
    """Return the names of the parameters that heated samples show.

    Those are the parameters of the kinetics and the composition, and of the heats on which the
    measured quantities rest.
    """
    keys = {key for quantity in quantities for key in quantity.rests_on}
    cold = {key: 0.0 for key in HEATS if key not in keys}
    kinetics = [reaction.model_copy(update=cold) for reaction in material.reactions.values()]
    used = parameters_in(*kinetics) | names_in(material.composition)
    return used | {name for leaf in numbers_in_keys(material, keys) for name in named_by(leaf)}


def numbers_in_keys(material: Material, keys: Collection[str]) -> list[float | str]:
    """Return the numbers that keys of components and reactions hold."""
    parts = [*material.components.values(), *material.reactions.values()]
    return [leaf for p in parts for at, leaf, _ in numbers(p) if at.split(".")[0] in keys]


def names_in(composition: Mapping[str, float | str]) -> set[str]:
    """Return the names of the parameters among mass fractions."""
    return {name for f in composition.values() if f != REST for name in named_by(f)}
