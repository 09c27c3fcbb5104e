"""From the description in words to the arrays of the kernels."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.experiment import EmissivityDepth, FluxTable, Gasification, Side
from pyrofit.solver.arrays import (
    TABLE_SIZE,
    TABLE_TEMPERATURES_K,
    Exposure,
    FloatArray,
    IntArray,
    Material,
    Network,
    Surface,
)
from pyrofit.solver.grid import Virgin

Values = Mapping[str, float]
LEAST_SHARE = 0.01
"""Least value of a linear property, relative to its reference value."""


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
    assert isinstance(prop, words.Linear | words.PowerLaw)
    value = value_of(prop.value, values)
    reference = value_of(prop.reference_temperature_K, values)
    if isinstance(prop, words.Linear):
        slope = value_of(prop.slope_1_K, values)
        return value * np.maximum(LEAST_SHARE, 1.0 + slope * (TABLE_TEMPERATURES_K - reference))
    return value * (TABLE_TEMPERATURES_K / reference) ** value_of(prop.exponent, values)


def _stack(properties: list[Any], values: Values) -> FloatArray:
    """Return one row per component, of one column where no property depends on temperature."""
    if all(isinstance(p, float | str) for p in properties):
        return np.array([[value_of(p, values)] for p in properties])
    tables = [property_table(p, values) for p in properties]
    return np.array([t if t.size > 1 else np.full(TABLE_SIZE, t[0]) for t in tables])


def lower_material(material: words.Material, values: Values) -> Material:
    """Return the component properties as arrays, in the order of ``material.components``."""
    parts = list(material.components.values())
    density = np.array([value_of(c.density_kg_m3, values) for c in parts])
    return Material(
        specific_volume=1.0 / density,
        conductivity=_stack([c.conductivity_W_mK for c in parts], values),
        specific_heat=_stack([c.specific_heat_J_kgK for c in parts], values),
        emissivity=np.array([value_of(c.emissivity, values) for c in parts]),
        absorption=np.array([value_of(c.absorption_1_m or 0.0, values) for c in parts]),
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


def is_separate(material: words.Material) -> bool:
    """Tell whether no reaction has to do with another one."""
    return material.derived("network", _plan).plain


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


def _surface(side: Side, values: Values) -> Surface:
    return Surface(
        h=value_of(side.h_W_m2K, values),
        h_cube_root=value_of(side.h_cube_root_W_m2K43, values),
        gas_temperature=value_of(side.gas_temperature_K, values),
        wall_temperature=value_of(side.wall_temperature_K, values),
    )


def lower_exposure(
    experiment: Gasification, material: words.Material, arrays: Material, values: Values
) -> Exposure:
    """Return what acts on the sample as arrays."""
    flux = experiment.front.flux_W_m2
    if isinstance(flux, FluxTable):
        times = np.array(flux.time_s)
        fluxes = np.array([value_of(q, values) for q in flux.flux_W_m2])
    else:
        times, fluxes = np.zeros(1), np.array([value_of(flux, values)])
    foil = experiment.sample.foil
    capacity = 0.0
    if foil is not None:
        mass = value_of(foil.thickness_m, values) * value_of(foil.density_kg_m3, values)
        capacity = mass * value_of(foil.specific_heat_J_kgK, values)
    return Exposure(
        front=_surface(experiment.front, values),
        back=_surface(experiment.back, values),
        flux_time=times,
        flux=fluxes,
        back_emissivity=value_of(experiment.back.emissivity, values),
        foil_capacity=capacity,
        foil_opaque=foil is not None,
        mixing_depth=_mixing_depth(experiment, material, arrays, values),
    )


def _mixing_depth(
    experiment: Gasification, material: words.Material, arrays: Material, values: Values
) -> float:
    depth = experiment.sample.emissivity_depth
    if not isinstance(depth, EmissivityDepth):
        return value_of(depth, values)
    names = list(material.components)
    composition = experiment.sample.layers[0].composition or material.composition
    share = fractions(composition, names, values)
    volume = share * arrays.specific_volume
    k = float(volume @ _at(arrays.conductivity, experiment, values)) / volume.sum()
    rho_c = float(share @ _at(arrays.specific_heat, experiment, values)) / volume.sum()
    return value_of(depth.cell_size_factor, values) * math.sqrt(k / rho_c)


def _at(table: FloatArray, experiment: Gasification, values: Values) -> FloatArray:
    if table.shape[1] == 1:
        return table[:, 0]
    T = value_of(experiment.sample.initial_temperature_K, values)
    return np.array([np.interp(T, TABLE_TEMPERATURES_K, row) for row in table])


def lower_virgin(experiment: Gasification, material: words.Material, values: Values) -> Virgin:
    """Return what the sample is before it reacts."""
    layers = experiment.sample.layers
    composition = layers[0].composition or material.composition
    return Virgin(
        share=fractions(composition, list(material.components), values),
        thickness=sum(value_of(layer.thickness_m, values) for layer in layers),
        temperature=value_of(experiment.sample.initial_temperature_K, values),
    )


def lower_cells(
    experiment: Gasification,
    material: words.Material,
    arrays: Material,
    values: Values,
    cells: int,
) -> FloatArray:
    """Return the initial masses [kg/m2], shape (cells, components), front first.

    The cells are shared out by thickness, at least two to a layer, equally thick in a layer.
    """
    names = list(material.components)
    layers = experiment.sample.layers
    thickness = [value_of(layer.thickness_m, values) for layer in layers]
    parts = []
    for layer, size in zip(layers, thickness, strict=True):
        count = cells if len(layers) == 1 else max(2, round(cells * size / sum(thickness)))
        share = fractions(layer.composition or material.composition, names, values)
        mass = size / float(share @ arrays.specific_volume)
        parts.append(np.full((count, len(names)), share * mass / count))
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
