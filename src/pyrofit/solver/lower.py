"""From a material in words to the arrays of the kernels; experiments: `lower_experiment`."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.solver.arrays import (
    TABLE_SIZE,
    TABLE_TEMPERATURES_K,
    FloatArray,
    IntArray,
    Material,
    Network,
)

Values = Mapping[str, float]
LEAST_SHARE = 0.01
"""Least value of a linear property, relative to its reference value, and of a changed one."""


def fractions(
    composition: Mapping[str, float | str], names: list[str], values: Values
) -> FloatArray:
    """Return the mass fractions of the named components, shape (components,)."""
    out = np.zeros(len(names))
    rest = None
    for name, fraction in composition.items():
        if fraction == words.REST:
            rest = names.index(name)
        else:
            out[names.index(name)] = value_of(fraction, values)
    if rest is not None:
        out[rest] = 1.0 - out.sum()
    return out


def property_table(prop: object, values: Values) -> FloatArray:
    """Return p at the nodes of `TABLE_TEMPERATURES_K`, or one value for a constant.

    A linear property ends at 1 % of its reference value: it must not become negative.
    """
    if isinstance(prop, float | str):
        return np.array([value_of(prop, values)])
    if isinstance(prop, words.Table):
        points = [value_of(v, values) for v in prop.value]
        return np.interp(TABLE_TEMPERATURES_K, prop.temperature_K, points)
    if isinstance(prop, words.Changed):
        return _changed(prop, values)
    assert isinstance(prop, words.Linear | words.PowerLaw)
    value = value_of(prop.value, values)
    reference = value_of(prop.reference_temperature_K, values)
    if isinstance(prop, words.Linear):
        slope = value_of(prop.slope_1_K, values)
        return value * np.maximum(LEAST_SHARE, 1.0 + slope * (TABLE_TEMPERATURES_K - reference))
    return value * (TABLE_TEMPERATURES_K / reference) ** value_of(prop.exponent, values)


def _changed(prop: words.Changed, values: Values) -> FloatArray:
    """Return of(T) with slope, step and peak; nothing but of(T) where these are zero."""
    at = {
        name: value_of(getattr(prop, name), values)
        for name in words.Changed.model_fields
        if name != "of"
    }
    T = TABLE_TEMPERATURES_K
    of = property_table(prop.of, values)
    slope = 1.0 + at["slope_1_K"] * (T - at["reference_temperature_K"])
    # 1 / (1 + exp(-x)), which would overflow.
    passed = 0.5 + 0.5 * np.tanh(0.5 * (T - at["step_temperature_K"]) / at["step_width_K"])
    away = (T - at["peak_temperature_K"]) / at["peak_width_K"]
    height = at["peak_area"] / (math.sqrt(2.0 * math.pi) * at["peak_width_K"])
    changed = of * slope + at["step"] * passed + height * np.exp(-0.5 * away * away)
    return np.asarray(np.maximum(changed, LEAST_SHARE * of))


def _stack(properties: list[Any], values: Values) -> FloatArray:
    """Return one row per component, of one column where no property depends on temperature."""
    if all(isinstance(p, float | str) for p in properties):
        return np.array([[value_of(p, values)] for p in properties])
    tables = [property_table(p, values) for p in properties]
    return np.array([t if t.size > 1 else np.full(TABLE_SIZE, t[0]) for t in tables])


def lower_material(
    material: words.Material, values: Values, absorption_length: float = 0.0
) -> Material:
    """Return the component properties as arrays, in the order of ``material.components``.

    An ``absorption_length`` [m] above zero holds for all components.
    """
    parts = list(material.components.values())
    density = np.array([value_of(c.density_kg_m3, values) for c in parts])
    return Material(
        specific_volume=1.0 / density,
        expansion=_stack([c.expansion for c in parts], values),
        conductivity=_stack([c.conductivity_W_mK for c in parts], values),
        specific_heat=_stack([c.specific_heat_J_kgK for c in parts], values),
        emissivity=np.array([value_of(c.emissivity, values) for c in parts]),
        absorption=np.full(len(parts), 1.0 / absorption_length)
        if absorption_length > 0.0
        else np.array([value_of(c.absorption_1_m or 0.0, values) for c in parts]),
    )


def rate_factor(reaction: words.Reaction, values: Values) -> float:
    """Return A [1/s]: given, or k_ref exp(E/(R T_ref))."""
    if reaction.A_1_s is not None:
        return value_of(reaction.A_1_s, values)
    assert reaction.reference_rate_1_s is not None
    assert reaction.reference_temperature_K is not None
    rate = value_of(reaction.reference_rate_1_s, values)
    temperature = value_of(reaction.reference_temperature_K, values)
    return rate * math.exp(value_of(reaction.E_J_mol, values) / (GAS_CONSTANT * temperature))


@dataclass(frozen=True)
class _Plan:
    """What of a network no parameter changes."""

    reactions: tuple[str, ...]
    reactant: IntArray
    products: tuple[tuple[int, int, str], ...]
    """Reaction, component and its name, of every product."""
    residue: IntArray
    plain: bool
    """Whether every reaction has its own reactant and at most one, inert, product."""


def _plan(material: words.Material) -> _Plan:
    names = list(material.components)
    order = material.reaction_order()
    reactions = [material.reactions[name] for name in order]
    reactant = [names.index(r.reactant) for r in reactions]
    products = [
        (j, names.index(product), product)
        for j, reaction in enumerate(reactions)
        for product in reaction.products
    ]
    formed = {j: i for j, i, _ in reversed(products)}
    return _Plan(
        reactions=order,
        reactant=np.array(reactant, dtype=np.int64),
        products=tuple(products),
        residue=np.array([formed.get(j, 0) for j in range(len(order))], dtype=np.int64),
        plain=len(set(reactant)) == len(order)
        and len(formed) == len(products)
        and not any(i in reactant for _, i, _ in products),
    )


def is_separate(network: Network) -> bool:
    """Tell whether no reaction feeds or starves another one."""
    running = network.rate_factor > 0.0
    reactants = network.reactant[running]
    fed = network.yields[running][:, reactants] > 0.0
    return len(set(reactants.tolist())) == reactants.size and not bool(fed.any())


def lower_network(material: words.Material, values: Values, heats: bool = True) -> Network:
    """Return the reactions as arrays, sorted so that products react after their formation.

    Without ``heats`` the heats of reaction are left out (TGA prescribes the temperature).
    """
    plan = material.derived("network", _plan)
    order = [material.reactions[name] for name in plan.reactions]
    yields = np.zeros((len(order), len(material.components)))
    for j, i, product in plan.products:
        yields[j, i] = value_of(order[j].products[product], values)
    orders = [value_of(r.order, values) for r in order]
    first_order = all(n == 1.0 for n in orders)
    energies = [value_of(r.E_J_mol, values) / GAS_CONSTANT for r in order]
    return Network(
        reactant=plan.reactant,
        rate_factor=np.array([rate_factor(r, values) for r in order]),
        activation_temperature=np.array(energies),
        order=np.array(orders),
        heat=np.array([value_of(r.heat_of_reaction_J_kg, values) if heats else 0.0 for r in order]),
        yields=yields,
        gas=1.0 - yields.sum(axis=1),
        first_order=first_order,
        plain=first_order and plan.plain,
        residue=plan.residue,
        residue_yield=yields[np.arange(len(order)), plan.residue],
    )
