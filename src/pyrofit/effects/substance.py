"""Changes of the material that several effects make."""

from collections.abc import Collection, Mapping
from typing import Any

from pyrofit.effects.base import ComponentsChange, Numbers, changed, need
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import REST, Component, Material, Reaction
from pyrofit.model.properties import Changed
from pyrofit.model.slab import SlabExperiment

REFERENCE_RATE_1_S = 1e-3
"""At the reference temperature of a reaction that an effect adds."""


def properties_changed(key: str, **takes: str) -> ComponentsChange:
    """Return a change of one property of some components.

    ``takes`` maps a key of `Changed` to the parameter of the effect that it takes.
    """

    def change(material: Material, at: Numbers, of: Collection[str]) -> Material:
        numbers = {name: at[own] for name, own in takes.items()}
        components = {
            name: changed(component, **{key: Changed(of=getattr(component, key), **numbers)})
            if name in of
            else component
            for name, component in material.components.items()
        }
        return changed(material, components=components)

    return change


def together(*changes: ComponentsChange) -> ComponentsChange:
    """Return several changes as one."""

    def change(material: Material, at: Numbers, of: Collection[str]) -> Material:
        for part in changes:
            material = part(material, at, of)
        return material

    return change


def shares(material: Material) -> dict[str, float]:
    """Return the mass fractions of the virgin material as far as they are known.

    A parameter counts as 0, so that the rest beside it counts as the main component.
    """
    known = {n: s if isinstance(s, float) else 0.0 for n, s in material.composition.items()}
    rest = {n: 1.0 - sum(known.values()) for n, s in material.composition.items() if s == REST}
    return known | rest


def main_reaction(material: Material) -> tuple[str, Reaction]:
    """Return the first reaction of the reactant of which the virgin material has most."""
    share = shares(material)
    found = [(n, r) for n, r in material.reactions.items() if r.reactant in share]
    if not found:
        raise ValueError("no component of the virgin material reacts")
    return max(found, key=lambda item: share[item[1].reactant])


def with_main(material: Material, **update: Any) -> Material:
    """Return the material with its main reaction changed."""
    name, reaction = main_reaction(material)
    return changed(material, reactions={**material.reactions, name: changed(reaction, **update)})


def with_component(material: Material, name: str, component: Component) -> Material:
    """Return the material with a component added."""
    _refuse_known(name, material.components, "component")
    return changed(material, components={**material.components, name: component})


def with_reaction(material: Material, name: str, reaction: Reaction) -> Material:
    """Return the material with a reaction added behind its main one."""
    _refuse_known(name, material.reactions, "reaction")
    main, _ = main_reaction(material)
    reactions = {}
    for known, present in material.reactions.items():
        reactions[known] = present
        if known == main:
            reactions[name] = reaction
    return changed(material, reactions=reactions)


def with_part(material: Material, name: str, share: float | str, reaction: Reaction) -> Material:
    """Return the material with a share of its main component that has a reaction of its own."""
    main = main_reaction(material)[1].reactant
    material = with_component(material, name, material.components[main])
    composition = dict(material.composition)
    if composition[main] != REST:
        if any(isinstance(s, str) and s != REST for s in composition.values()):
            raise ValueError(f"the composition must give '{main}' as '{REST}'")
        composition |= shares(material) | {main: REST}
    material = changed(material, composition=composition | {name: share})
    return with_reaction(material, name, reaction)


@need("a TGA, or a layer without a composition of its own")
def is_of_the_material(experiment: Experiment) -> bool:
    """Tell whether a part of the sample has the composition of the material."""
    if not isinstance(experiment, SlabExperiment):
        return True
    return any(layer.composition is None for layer in experiment.sample.layers)


def _refuse_known(name: str, known: Mapping[str, object], what: str) -> None:
    if name in known:
        raise ValueError(f"the material has a {what} '{name}' already; rename it")


def refuse_translucent(material: Material, at: Numbers) -> Material:
    """Return the material itself, if it absorbs at its surface.

    Raises
    ------
    ValueError
        If its components have absorption coefficients of their own.
    """
    if any(c.absorption_1_m is not None for c in material.components.values()):
        raise ValueError("the material absorbs in depth already, by absorption_1_m")
    return material
