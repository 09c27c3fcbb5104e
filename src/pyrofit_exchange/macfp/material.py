"""A parameter set as the material of a study, and back."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from pyrofit.errors import DataError, StudyError
from pyrofit.model.material import Material
from pyrofit_exchange.fds.materials import NO_CATALYSIS
from pyrofit_exchange.macfp.densities import constant_of, density_back, density_of
from pyrofit_exchange.macfp.forms import (
    NOTHING,
    Nothing,
    PerComponent,
    PerReaction,
    Single,
    alike,
    from_study,
    number_or_none,
    single,
    to_study,
)
from pyrofit_exchange.macfp.schema import StrictSet

_PLACEHOLDER = {
    "density_kg_m3": 1000.0,
    "conductivity_W_mK": 0.2,
    "specific_heat_J_kgK": 1500.0,
}
"""Properties of a component where a set gives kinetics alone; a TGA does not depend on them."""


def has_heat(given: StrictSet) -> bool:
    """Tell whether a set describes a slab, not the kinetics alone."""
    thermal, transport = given.thermodynamics, given.transport
    if thermal is None or transport is None:
        return False
    needed = thermal.heat_capacity, thermal.density, transport.conductivity, transport.emissivity
    return not any(isinstance(p, Nothing) for p in needed)


def material_of(given: StrictSet) -> dict[str, Any]:
    """Return the part `material` of a study.

    Raises
    ------
    DataError
        A property has a form that a study has no words for.
    """
    names, kinetics = given.composition.names, given.kinetics
    components = {name: _component(given, i) for i, name in enumerate(names)}
    reactions = {}
    for i, reactant in enumerate(kinetics.reactants):
        product, nu = kinetics.products[i][0], kinetics.yields[i]
        reactions[f"reaction_{i + 1}"] = {
            "reactant": names[reactant[0] - 1],
            "products": {names[product - 1]: nu} if product else {},
            "A_1_s": kinetics.A[i],
            "E_J_mol": kinetics.E[i],
            "order": kinetics.order[i],
            "heat_of_reaction_J_kg": _of_reaction(_heat(given), i),
            "heat_of_combustion_J_kg": _of_reaction(_combustion(given), i),
        }
    return {
        "components": components,
        "reactions": reactions,
        "composition": dict(zip(names, given.composition.fractions, strict=True)),
    }


def _heat(given: StrictSet) -> Any:
    return NOTHING if given.thermodynamics is None else given.thermodynamics.heat_of_pyrolysis


def _combustion(given: StrictSet) -> Any:
    return NOTHING if given.combustion is None else given.combustion.heat


def _of_reaction(form: Any, i: int) -> float:
    if isinstance(form, PerReaction):
        return form.value[i]
    return form.value if isinstance(form, Single) else 0.0


def _component(given: StrictSet, i: int) -> dict[str, Any]:
    if not has_heat(given):
        return dict(_PLACEHOLDER)
    assert given.thermodynamics is not None
    assert given.transport is not None

    def curve(form: Any) -> Any:
        return form.value[i] if isinstance(form, PerComponent) else form

    name = given.composition.names[i]
    density, expansion = density_of(curve(given.thermodynamics.density), name)
    made = {
        "density_kg_m3": density,
        "conductivity_W_mK": to_study(curve(given.transport.conductivity)),
        "specific_heat_J_kgK": to_study(curve(given.thermodynamics.heat_capacity)),
        "emissivity": constant_of(curve(given.transport.emissivity), name, "Emissivity"),
    }
    if expansion is not None:
        made["expansion"] = expansion
    absorption = curve(given.transport.absorption)
    if not isinstance(absorption, Nothing):
        made["absorption_1_m"] = constant_of(absorption, name, "Absorption")
    return made


def strict_of(material: Material, about: Mapping[str, Any], thermal: bool = True) -> StrictSet:
    """Return a parameter set of a material whose numbers are all given.

    Parameters
    ----------
    material
        The material.
    about
        `Material`, `Lab` and `Calibration` of the set.
    thermal
        Whether the properties of the components are known.

    Raises
    ------
    DataError
        The data base has no words for a part of it.
    """
    names = [n for n in material.components if n in material.own]
    parts: dict[str, Any] = {
        **about,
        "Composition": {
            "Number of Components": len(names),
            "Component Names": names,
            "Initial Mass Fraction": _fractions(material, names),
        },
        "Kinetics": _kinetics(material, names),
    }
    heats = [number_or_none(r.heat_of_reaction_J_kg) for r in material.reactions.values()]
    burns = [number_or_none(r.heat_of_combustion_J_kg) for r in material.reactions.values()]
    if thermal:
        try:
            parts |= _thermal(material, names, heats)
        except TypeError as error:
            raise DataError(
                f"{error} has no words in the data base; give the property as a number, a table, "
                "a straight line or a power of the temperature."
            ) from None
    if any(burns):
        parts["Combustion"] = {"Heat of Combustion": _reactions(burns)}
    return StrictSet.model_validate(parts)


def _fractions(material: Material, names: Sequence[str]) -> list[float]:
    given = {n: x for n, x in material.composition.items() if not isinstance(x, str)}
    rest = [n for n, x in material.composition.items() if isinstance(x, str)]
    known = {n: number_or_none(x) for n, x in given.items()}
    if rest:
        known[rest[0]] = 1.0 - sum(known.values())
    return [known.get(name, 0.0) for name in names]


def _kinetics(material: Material, names: Sequence[str]) -> dict[str, Any]:
    places = {name: i for i, name in enumerate(names, start=1)}
    reactions = list(material.reactions.values())
    if faster := [r.reactant for r in reactions if number_or_none(r.catalysis) > 0.0]:
        raise StudyError(NO_CATALYSIS.format(faster[0]))
    if several := [r.reactant for r in reactions if len(r.products) > 1]:
        raise DataError(f"the reaction of '{several[0]}' has several solid products; give one.")
    return {
        "Reactants": [[places[r.reactant]] for r in reactions],
        "Products": [[places[p] for p in r.products] or [0] for r in reactions],
        "Pre-exponential": [_A(r) for r in reactions],
        "Activation Energy": [number_or_none(r.E_J_mol) for r in reactions],
        "Reaction Order": [number_or_none(r.order) for r in reactions],
        "Solid Yield": [sum(number_or_none(nu) for nu in r.products.values()) for r in reactions],
    }


def _A(reaction: Any) -> float:
    """Return the pre-exponential factor, A = k_ref exp(E/(R T_ref)) where that is given."""
    if reaction.A_1_s is not None:
        return number_or_none(reaction.A_1_s)
    from pyrofit.constants import GAS_CONSTANT

    T, k = (
        number_or_none(reaction.reference_temperature_K),
        number_or_none(reaction.reference_rate_1_s),
    )
    return k * math.exp(number_or_none(reaction.E_J_mol) / (GAS_CONSTANT * T))


def _thermal(material: Material, names: Sequence[str], heats: Sequence[float]) -> dict[str, Any]:
    parts = [material.components[name] for name in names]
    absorption = [c.absorption_1_m for c in parts]
    return {
        "Thermodynamics": {
            "Heat Capacity": _components([from_study(c.specific_heat_J_kgK) for c in parts]),
            "Heat of Pyrolysis": _reactions(heats),
            "Density": _components([density_back(c) for c in parts]),
        },
        "Transport": {
            "Conductivity": _components([from_study(c.conductivity_W_mK) for c in parts]),
            "Absorption": _components(
                [NOTHING if a is None else single(number_or_none(a)) for a in absorption]
            ),
            "Emissivity": _components([single(number_or_none(c.emissivity)) for c in parts]),
        },
    }


def _components(curves: Sequence[Any]) -> Any:
    first = curves[0]
    if all(alike(c.model_dump(), first.model_dump()) for c in curves):
        return first
    return PerComponent(form="Component Specific", value=tuple(curves))


def _reactions(values: Sequence[float]) -> Any:
    if all(value == values[0] for value in values):
        return single(values[0])
    return PerReaction(form="Reaction Specific", value=tuple(values))
