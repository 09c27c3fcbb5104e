"""From a material in words to the arrays of the kernels.

Parameter values are numbers, or arrays of shape (sets,): then everything is made for all sets at
once. The last axis of every result is the sets, also where there is one. Properties are tabulated
by `lower_property`, experiments lowered by `lower_experiment`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial, reduce
from typing import Any

import numpy as np

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.slab import Sample
from pyrofit.numerics import functions
from pyrofit.solver.arrays import (
    TABLE_SIZE,
    BoolArray,
    FloatArray,
    IntArray,
    Material,
    Network,
    Value,
    Values,
)
from pyrofit.solver.lower_property import property_table, stack

OPAQUE_1_M = 1e6
"""Absorption coefficient of an opaque body behind or beside a translucent material."""


def fractions(
    composition: Mapping[str, float | str], names: list[str], values: Values, sets: int = 1
) -> FloatArray:
    """Return the mass fractions of the named components, shape (components, sets)."""
    out = np.zeros((len(names), sets))
    rest = None
    for name, fraction in composition.items():
        if fraction == words.REST:
            rest = names.index(name)
        else:
            out[names.index(name)] = value_of(fraction, values)
    if rest is not None:
        out[rest] = 1.0 - total(out)
    return out


def total(rows: FloatArray) -> FloatArray:
    """Return the sum of the rows, one after the other: the same bits for any number of sets."""
    return np.asarray(reduce(np.add, rows))


@dataclass(frozen=True)
class _Described:
    """The part of the component properties that no parameter changes."""

    numbers: tuple[float | str, ...]
    """Density, absorption coefficient and emissivity of each component; if none depends on
    temperature, the properties of `_TABLES`, too."""
    plain: bool
    """Whether none does."""
    own: BoolArray
    """Whether a component is of the material itself, shape (components, 1)."""
    alike: IntArray
    constant: BoolArray


def _described(material: words.Material) -> _Described:
    parts = material.components.values()
    names = ("density_kg_m3", "absorption_1_m", "emissivity")
    rows = [[getattr(c, name) or 0.0 for c in parts] for name in names]
    constant = _constant(material)
    if constant.all():
        rows += [[getattr(c, table) for c in parts] for table in _TABLES]
    return _Described(
        numbers=tuple(number for row in rows for number in row),
        plain=bool(constant.all()),
        own=np.array([n in material.own for n in material.components])[:, None],
        alike=_alike(material),
        constant=constant,
    )


def _tables(material: words.Material, name: str, values: Values, sets: int) -> FloatArray:
    """Return one table per component, of one node where no property depends on temperature.

    A property that several components have alike is tabulated once.
    """
    properties, same = material.derived(name, partial(_properties, name))
    if all(isinstance(p, float | str) for p in properties):
        return stack([value_of(p, values) for p in properties], sets)[:, None, :]
    tables = np.empty((len(properties), TABLE_SIZE, sets))
    for i, first in enumerate(same):
        table = property_table(properties[i], values, sets) if first == i else tables[first]
        tables[i] = table
    return tables


def _properties(name: str, material: words.Material) -> tuple[list[Any], list[int]]:
    """Return a property of each component, and the first component with the same one."""
    found = [getattr(c, name) for c in material.components.values()]
    return found, [found.index(p) for p in found]


def lower_material(
    material: words.Material,
    values: Values,
    sets: int = 1,
    absorption_length: Value = 0.0,
    density_factor: Value = 1.0,
) -> Material:
    """Return the component properties as arrays, in the order of ``material.components``.

    An ``absorption_length`` [m] above zero holds for all components of the material itself, and so
    does the ``density_factor``, which multiplies density and conductivity.
    """
    described = material.derived("described", _described)
    given = stack([value_of(number, values) for number in described.numbers], sets)
    rows = given.reshape(-1, len(material.components), sets)
    density, absorption, emissivity = rows[:3]
    if described.plain:
        expansion, conductivity, heat, factor = rows[3:, :, None]
    else:
        tables = (_tables(material, name, values, sets) for name in _TABLES)
        expansion, conductivity, heat, factor = tables
    absorption = _absorption(absorption, described.own, absorption_length)
    if isinstance(density_factor, np.ndarray) or density_factor != 1.0:
        denser = np.where(described.own, density_factor, 1.0)
        density, conductivity = denser * density, denser[:, None] * conductivity
    return Material(
        specific_volume=1.0 / density,
        expansion=expansion,
        conductivity=conductivity,
        specific_heat=heat,
        emissivity=emissivity,
        absorption=absorption[:, None, :] * factor,
        alike=described.alike,
        constant=described.constant,
    )


def _absorption(given: FloatArray, own: BoolArray, length: Value) -> FloatArray:
    """Return the absorption coefficients [1/m], shape (components, sets)."""
    if isinstance(length, np.ndarray) or length > 0.0:
        long = np.asarray(length)
        inverse = np.where(long > 0.0, 1.0 / np.where(long > 0.0, long, 1.0), given)
        given = np.where(own, inverse, given)
    if not own.all():
        opaque = ~own & (given == 0.0) & (given > 0.0).any(axis=0)
        given = np.where(opaque, OPAQUE_1_M, given)
    return given


_TABLES = "expansion", "conductivity_W_mK", "specific_heat_J_kgK", "absorption_factor"


def _alike(material: words.Material) -> IntArray:
    """Return the first component that is described as each one, but for its density."""
    described = [
        (name in material.own, c.absorption_1_m, *(getattr(c, table) for table in _TABLES))
        for name, c in material.components.items()
    ]
    return np.array([described.index(d) for d in described])


def _constant(material: words.Material) -> BoolArray:
    """Tell of each component whether no property depends on temperature."""
    return np.array(
        [
            all(isinstance(getattr(c, table), float | str) for table in _TABLES)
            for c in material.components.values()
        ]
    )


def rate_factor(reaction: words.Reaction, values: Values) -> Value:
    """Return A [1/s]: given, or k_ref exp(E/(R T_ref))."""
    if reaction.A_1_s is not None:
        return value_of(reaction.A_1_s, values)
    assert reaction.reference_rate_1_s is not None
    assert reaction.reference_temperature_K is not None
    rate = value_of(reaction.reference_rate_1_s, values)
    temperature = value_of(reaction.reference_temperature_K, values)
    return rate * functions.exp(value_of(reaction.E_J_mol, values) / (GAS_CONSTANT * temperature))


def oxygen_factor(reaction: words.Reaction, oxygen: float | str, values: Values) -> Value:
    """Return X^n_O2, by which the volume fraction X of oxygen multiplies the rate of a reaction."""
    return functions.power(value_of(oxygen, values), value_of(reaction.oxygen_order, values))


@dataclass(frozen=True)
class _Plan:
    """The part of a network that no parameter changes."""

    reactions: tuple[words.Reaction, ...]
    numbers: tuple[tuple[float | str, ...], ...]
    """The numbers of `_NUMBERS` of each reaction."""
    reactant: IntArray
    products: tuple[tuple[int, int, str], ...]
    """Reaction, component and its name, of every product."""
    residue: IntArray
    plain: bool
    """Whether every reaction has its own reactant and at most one, inert, product."""


_NUMBERS = (
    "order",
    "catalysis",
    "E_J_mol",
    "oxygen_order",
    "oxygen_depth_m",
    "oxygen_use",
    "heat_of_reaction_J_kg",
    "heat_of_combustion_J_kg",
)


def _plan(material: words.Material) -> _Plan:
    names = list(material.components)
    reactions = tuple(material.reactions[name] for name in material.reaction_order())
    reactant = [names.index(r.reactant) for r in reactions]
    products = [
        (j, names.index(product), product)
        for j, reaction in enumerate(reactions)
        for product in reaction.products
    ]
    formed = {j: i for j, i, _ in reversed(products)}
    return _Plan(
        reactions=reactions,
        numbers=tuple(tuple(getattr(r, name) for r in reactions) for name in _NUMBERS),
        reactant=np.array(reactant, dtype=np.int64),
        products=tuple(products),
        residue=np.array([formed.get(j, 0) for j in range(len(reactions))], dtype=np.int64),
        plain=len(set(reactant)) == len(reactions)
        and len(formed) == len(products)
        and not any(i in reactant for _, i, _ in products),
    )


def is_separate(network: Network) -> BoolArray:
    """Tell whether each reaction is solved exactly from k dt alone, shape (sets,).

    None feeds or starves another one, and none of another order than the first is catalysed.
    """
    running = network.root_factor > 0.0
    mixed = running & (network.catalysis > 0.0) & (network.order != 1.0)
    separate: BoolArray = ~np.any(mixed, axis=0)
    for j, a in enumerate(network.reactant.tolist()):
        for k, b in enumerate(network.reactant.tolist()):
            fed = network.yields[j, b] > 0.0
            if j != k and a == b:
                fed = np.ones_like(fed)
            separate &= ~(running[j] & running[k] & fed)
    return separate


def lower_network(
    material: words.Material,
    values: Values,
    sets: int = 1,
    heats: bool = True,
    burning: bool = True,
    oxygen: float | str = 0.0,
) -> Network:
    """Return the reactions as arrays, sorted so that products react after their formation.

    Without ``heats`` the heats of reaction are left out, without ``burning`` those of combustion:
    the mass of a sample whose temperature is prescribed depends on neither. ``oxygen`` is the
    volume fraction in a gas that reaches all of the sample. That of a slab is 1 where the kernel
    takes its fall over depth and time into account, and 0 where there is none.
    """
    plan = material.derived("network", _plan)
    count = len(plan.reactions)
    of_heat, of_burnt = plan.numbers[-2:]
    none = (0.0,) * count
    last = of_heat if heats or burning else none, of_burnt if burning else none
    rows = (number for row in (*plan.numbers[:-2], *last) for number in row)
    numbers = stack([value_of(number, values) for number in rows], sets)
    order, catalysis, energy, oxygen_order, depth, use, heat, burnt = numbers.reshape(
        len(_NUMBERS), count, sets
    )
    yields = np.zeros((count, len(material.components), sets))
    for j, i, product in plan.products:
        yields[j, i] = value_of(plan.reactions[j].products[product], values)
    factor = stack([rate_factor(r, values) for r in plan.reactions], sets)
    if material.oxidises:
        factor *= stack([oxygen_factor(r, oxygen, values) for r in plan.reactions], sets)
    return Network(
        reactant=plan.reactant,
        root_factor=np.sqrt(factor),
        activation_temperature=energy / GAS_CONSTANT,
        order=order,
        catalysis=catalysis,
        oxygen_order=oxygen_order,
        oxygen_fall=oxygen_order / depth,
        oxygen_use=use,
        heat=heat,
        yields=yields,
        gas=1.0 - total(yields.swapaxes(0, 1)),
        combustion=burnt,
        glow=np.where(oxygen_order > 0.0, np.maximum(-heat, 0.0), 0.0),
        burns=False,
        oxidises=material.oxidises and oxygen != 0.0,
        first_order=bool(np.all(order == 1.0) and not np.any(catalysis)),
        catalysed=bool(np.any(catalysis)),
        plain=plan.plain,
        residue=plan.residue,
        residue_yield=yields[np.arange(count), plan.residue],
    )


class Substance:
    """A material with the values of its parameters, lowered once for all experiments on it."""

    def __init__(self, material: words.Material, values: Values, sets: int = 1) -> None:
        self.material, self.values, self.sets = material, values, sets
        self._properties: dict[tuple[float | str, float | str], Material] = {}
        self._smaller: dict[frozenset[str], Substance] = {}
        self._networks: dict[bool, Network] = {}

    def of(self, sample: Sample) -> "Substance":
        """Return it without the inert components, such as boards, that a sample does not have.

        Their mass is zero in every cell, so they only cost time.
        """
        bodies = sample.bodies
        material = self.material.derived(
            f"with {sorted(bodies)}", lambda m: m.without_bodies_but(bodies)
        )
        if material is self.material:
            return self
        if bodies not in self._smaller:
            self._smaller[bodies] = Substance(material, self.values, self.sets)
        return self._smaller[bodies]

    def network(self, oxygen: float | str) -> Network:
        """Return the reactions of a slab at whose surface there is so much oxygen, or none."""
        some = self.material.oxidises and oxygen != 0.0
        if some not in self._networks:
            self._networks[some] = lower_network(
                self.material, self.values, self.sets, oxygen=float(some)
            )
        return self._networks[some]

    def properties(self, absorption_length: float | str, density_factor: float | str) -> Material:
        """Return the component properties of a sample with such numbers, see `lower_material`."""
        key = absorption_length, density_factor
        if key not in self._properties:
            length, denser = (value_of(number, self.values) for number in key)
            self._properties[key] = lower_material(
                self.material, self.values, self.sets, length, denser
            )
        return self._properties[key]
