"""The description of a material in words, evaluated for given parameter values.

Symbols: i component, j reaction, xi_j extent: the mass that reaction j has consumed, per kg of
virgin sample.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import expit, log_expit

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.properties import Changed, Linear, Table
from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray, IntArray

Values = Mapping[str, float]
LEAST_SHARE = 0.01
"""Least value of a linear property, relative to its reference value, and of a changed one."""
COLDEST_K, HOTTEST_K = 50.0, 5000.0
"""Range of T in which properties and rates follow it."""
LEAST_REMAINDER = 1e-6
"""m/m_formed = u below which a reaction of an order below 1 goes on like one of first order.

The slope of u^n is infinite at u = 0, where no implicit method finds its way.
"""
OPAQUE_1_M = 1e6
"""Absorption coefficient of an opaque body beside a translucent material."""
LEAST_FORMED = 1e-12
"""Mass ever present, relative to the sample's, from which m/m_formed can be told."""


@dataclass(frozen=True)
class Property:
    """A property p(T) of all components."""

    given: tuple[Any, ...]
    values: Values
    factor: FloatArray | float = 1.0
    """Multiplies p_i, shape (components,)."""

    def of(self, T: FloatArray) -> FloatArray:
        """Return p_i(T), shape (..., components) for T [K] of shape (...,)."""
        return np.stack([self._one(p, T) for p in self.given], axis=-1) * self.factor

    def _one(self, given: Any, T: FloatArray) -> FloatArray:
        if isinstance(given, float | str):
            return np.full(T.shape, value_of(given, self.values))
        if isinstance(given, Table):
            points = [value_of(v, self.values) for v in given.value]
            factor = value_of(given.factor, self.values)
            return np.asarray(factor * np.interp(T, given.temperature_K, points))
        if isinstance(given, Changed):
            return self._changed(given, T)
        value = value_of(given.value, self.values)
        reference = value_of(given.reference_temperature_K, self.values)
        if isinstance(given, Linear):
            rise = value_of(given.slope_1_K, self.values) * (T - reference)
            return np.asarray(value * np.maximum(1.0 + rise, LEAST_SHARE))
        return np.asarray(
            value * functions.power(T / reference, value_of(given.exponent, self.values))
        )

    def _changed(self, given: Changed, T: FloatArray) -> FloatArray:
        """Return of(T) with slope, bend, smooth step, peak and thinning, at least 1 % of of(T)."""

        def number(name: str) -> float:
            return value_of(getattr(given, name), self.values)

        def scaled(name: str) -> float:
            return number("scale") * number(name)

        of = self._one(given.of, T)
        rise = scaled("slope_1_K") * (T - number("reference_temperature_K"))
        above = (T - number("step_temperature_K")) / number("step_width_K")
        rise = rise - scaled("bend") * number("step_width_K") * log_expit(-above)
        passed = expit(above)
        width = number("peak_width_K")
        bell = functions.exp(-0.5 * ((T - number("peak_temperature_K")) / width) ** 2)
        peak = scaled("peak_area") / (width * np.sqrt(2.0 * np.pi)) * bell
        changed = of * (1.0 + rise) + scaled("step") * passed + peak
        changed /= np.maximum(1.0 + scaled("thinning") * passed, LEAST_SHARE)
        return np.asarray(np.maximum(changed, LEAST_SHARE * of))


@dataclass(frozen=True)
class Reactions:
    """All reactions, in the order of the description."""

    reactant: IntArray
    A: FloatArray
    """[1/s]."""
    E_R: FloatArray
    """E/R [K]."""
    order: FloatArray
    catalysis: FloatArray
    """K of autocatalysis [-]."""
    oxygen_order: FloatArray
    oxygen_depth: FloatArray
    """In which the volume fraction of oxygen falls to 1/e [m]."""
    oxygen_use: FloatArray
    """[kg of oxygen per kg of reactant]."""
    heat: FloatArray
    """[J per kg of reactant], positive = endothermic."""
    combustion: FloatArray
    """[J per kg of gas]."""
    yields: FloatArray
    """nu_ji [kg/kg], shape (reactions, components)."""
    change: FloatArray
    """Change of component i by reaction j per kg of reactant, same shape."""

    @property
    def gas(self) -> FloatArray:
        """Gas formed per kg of reactant."""
        return np.asarray(1.0 - self.yields.sum(axis=1))

    def rate_constants(self, T: FloatArray | float) -> FloatArray:
        """Return A_j exp(-E_j/(R T)) [1/s], shape (..., reactions)."""
        return np.asarray(self.A * functions.exp(-self.E_R / np.asarray(T)[..., None]))

    @property
    def burning(self) -> FloatArray:
        """Heat of the gas that burns [J per kg of reactant]."""
        return np.asarray(self.gas * self.combustion)

    @property
    def glow(self) -> FloatArray:
        """Heat that reactions with oxygen release in the solid [J per kg of reactant]."""
        return np.where(self.oxygen_order > 0.0, np.maximum(-self.heat, 0.0), 0.0)

    def at_depth(self, x: FloatArray, oxygen: FloatArray | float) -> FloatArray:
        """Return (X exp(-x/L))^n at the depths x [m], shape (..., elements, reactions)."""
        share = functions.power(oxygen, self.oxygen_order)
        fall = self.oxygen_order / self.oxygen_depth
        return np.asarray(share * functions.exp(-fall * x[..., None]))

    def in_gas(self, oxygen: float) -> "Reactions":
        """Return the reactions with the volume fraction of oxygen as a factor of A."""
        return replace(self, A=self.A * functions.power(oxygen, self.oxygen_order))

    def amounts(self, virgin: FloatArray, extent: FloatArray) -> FloatArray:
        """Return the factors of the rate constants, m_formed u^n (1 + K (1 - u)), per kg of sample.

        u = m/m_formed, and m_formed is the mass ever present. ``virgin``: mass fractions of the
        sample, shape (..., components); ``extent``: xi_j, shape (..., reactions), like the result.
        """
        left = (virgin + linear.product(extent, self.change))[..., self.reactant]
        if np.all(self.order == 1.0) and not np.any(self.catalysis):
            return left
        formed = (virgin + linear.product(np.maximum(extent, 0.0), self.yields))[..., self.reactant]
        told = formed > LEAST_FORMED
        u = np.where(told, left / np.where(told, formed, 1.0), 1.0)
        least = np.where(self.order < 1.0, LEAST_REMAINDER, 0.0)
        faster = 1.0 + self.catalysis * (1.0 - np.clip(u, 0.0, 1.0))
        return np.asarray(left * functions.power(np.clip(u, least, 1.0), self.order - 1.0) * faster)


@dataclass(frozen=True)
class NumericSubstance:
    """A material with numbers."""

    names: list[str]
    density: FloatArray
    expansion: Property
    conductivity: Property
    specific_heat: Property
    emissivity: FloatArray
    absorption: FloatArray
    """kappa_i [1/m] without its factor; zero = opaque."""
    absorption_factor: Property
    reactions: Reactions


def substance(
    material: words.Material,
    values: Values,
    absorption_length: float = 0.0,
    density_factor: float = 1.0,
    conductivity_factor: float = 1.0,
) -> NumericSubstance:
    """Return the material with the numbers of the given parameter values.

    An ``absorption_length`` [m] above zero replaces that of every component of the material itself;
    other bodies are opaque unless described otherwise. The ``density_factor`` multiplies density
    and conductivity of the same components, the ``conductivity_factor`` conductivity alone.
    """
    parts = list(material.components.values())
    kappa = {
        name: _absorption(c, values, absorption_length if name in material.own else 0.0)
        for name, c in material.components.items()
    }
    if any(kappa.values()):
        opaque = {n: OPAQUE_1_M for n, of in kappa.items() if not of and n not in material.own}
        kappa |= opaque
    own = np.isin(list(material.components), sorted(material.own))
    denser = np.where(own, density_factor, 1.0)
    conductive = np.where(own, density_factor * conductivity_factor, 1.0)
    return NumericSubstance(
        names=list(material.components),
        density=denser * np.array([value_of(c.density_kg_m3, values) for c in parts]),
        expansion=Property(tuple(c.expansion for c in parts), values),
        conductivity=Property(tuple(c.conductivity_W_mK for c in parts), values, conductive),
        specific_heat=Property(tuple(c.specific_heat_J_kgK for c in parts), values),
        emissivity=np.array([value_of(c.emissivity, values) for c in parts]),
        absorption=np.array(list(kappa.values())),
        absorption_factor=Property(tuple(c.absorption_factor for c in parts), values),
        reactions=_reactions(material, values),
    )


def _absorption(component: words.Component, values: Values, length: float) -> float:
    if length > 0.0:
        return 1.0 / length
    given = component.absorption_1_m
    return 0.0 if given is None else value_of(given, values)


def mass_fractions(
    composition: Mapping[str, float | str], names: list[str], values: Values
) -> FloatArray:
    """Return the mass fractions of the named components; 'rest' is 1 less the others."""
    given = {n: value_of(f, values) for n, f in composition.items() if f != words.REST}
    rest = 1.0 - sum(given.values())
    return np.array([given.get(n, rest if n in composition else 0.0) for n in names])


def _reactions(material: words.Material, values: Values) -> Reactions:
    names = list(material.components)
    given = list(material.reactions.values())
    shape = (len(given), len(names))
    reactant = np.array([names.index(r.reactant) for r in given], dtype=np.int64)
    yields = np.zeros(shape)
    for j, reaction in enumerate(given):
        for product, nu in reaction.products.items():
            yields[j, names.index(product)] = value_of(nu, values)
    consumed = np.zeros(shape)
    consumed[np.arange(len(given)), reactant] = 1.0
    return Reactions(
        reactant=reactant,
        A=np.array([_rate_factor(r, values) for r in given]),
        E_R=np.array([value_of(r.E_J_mol, values) / GAS_CONSTANT for r in given]),
        order=np.array([value_of(r.order, values) for r in given]),
        catalysis=np.array([value_of(r.catalysis, values) for r in given]),
        oxygen_order=np.array([value_of(r.oxygen_order, values) for r in given]),
        oxygen_depth=np.array([value_of(r.oxygen_depth_m, values) for r in given]),
        oxygen_use=np.array([value_of(r.oxygen_use, values) for r in given]),
        heat=np.array([value_of(r.heat_of_reaction_J_kg, values) for r in given]),
        combustion=np.array([value_of(r.heat_of_combustion_J_kg, values) for r in given]),
        yields=yields,
        change=yields - consumed,
    )


def _rate_factor(reaction: words.Reaction, values: Values) -> float:
    if reaction.A_1_s is not None:
        return value_of(reaction.A_1_s, values)
    assert reaction.reference_temperature_K is not None
    assert reaction.reference_rate_1_s is not None
    E_RT = value_of(reaction.E_J_mol, values) / (
        GAS_CONSTANT * value_of(reaction.reference_temperature_K, values)
    )
    return float(value_of(reaction.reference_rate_1_s, values) * functions.exp(E_RT))
