"""From a material in words to the arrays of the kernels.

Parameter values are numbers, or arrays of shape (sets,): then everything is made for all sets at
once. The last axis of every result is the sets, also where there is one. Properties are tabulated
by `lower_property`, reactions lowered by `lower_network`, experiments by `lower_experiment`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.slab import Sample
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
from pyrofit.solver.lower_network import lower_network
from pyrofit.solver.lower_property import Numbers, property_table, stack, total

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


@dataclass(frozen=True)
class _Described:
    """The part of the component properties that no parameter changes."""

    numbers: Numbers
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
        numbers=Numbers(number for row in rows for number in row),
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
    conductivity_factor: Value = 1.0,
) -> Material:
    """Return the component properties as arrays, in the order of ``material.components``.

    An ``absorption_length`` [m] above zero holds for all components of the material itself, and so
    do the ``density_factor``, which multiplies density and conductivity, and the
    ``conductivity_factor``.
    """
    described = material.derived("described", _described)
    given = described.numbers.rows(values, sets)
    rows = given.reshape(-1, len(material.components), sets)
    density, absorption, emissivity = rows[:3]
    if described.plain:
        expansion, conductivity, heat, factor = rows[3:, :, None]
    else:
        tables = (_tables(material, name, values, sets) for name in _TABLES)
        expansion, conductivity, heat, factor = tables
    absorption = _absorption(absorption, described.own, absorption_length)
    if _differs(density_factor):
        denser = np.where(described.own, density_factor, 1.0)
        density, conductivity = denser * density, denser[:, None] * conductivity
    if _differs(conductivity_factor):
        conductivity = np.where(described.own, conductivity_factor, 1.0)[:, None] * conductivity
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


def _differs(factor: Value) -> bool:
    return isinstance(factor, np.ndarray) or factor != 1.0


def _absorption(given: FloatArray, own: BoolArray, length: Value) -> FloatArray:
    """Return the absorption coefficients [1/m], shape (components, sets)."""
    if isinstance(length, np.ndarray) or length > 0.0:
        long = np.asarray(length)
        inverse = np.where(long > 0.0, 1.0 / np.where(long > 0.0, long, 1.0), given)
        given = np.where(own, inverse, given)
    if np.count_nonzero(own) < own.size:
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


class Substance:
    """A material with the values of its parameters, lowered once for all experiments on it."""

    def __init__(self, material: words.Material, values: Values, sets: int = 1) -> None:
        self.material, self.values, self.sets = material, values, sets
        self._properties: dict[tuple[float | str, ...], Material] = {}
        self._smaller: dict[frozenset[str], Substance] = {}
        self._networks: dict[bool, Network] = {}

    def of(self, sample: Sample) -> "Substance":
        """Return it without the inert components, such as boards, that a sample does not have.

        Their mass is zero in every cell, so they only cost time.
        """
        bodies = sample.bodies
        material = self.material.derived(bodies, lambda m: m.without_bodies_but(bodies))
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

    def properties(self, sample: Sample) -> Material:
        """Return the component properties with the numbers of a sample, see `lower_material`."""
        key = sample.absorption_length_m, sample.density_factor, sample.conductivity_factor
        if key not in self._properties:
            length, denser, conductive = (value_of(number, self.values) for number in key)
            self._properties[key] = lower_material(
                self.material, self.values, self.sets, length, denser, conductive
            )
        return self._properties[key]
