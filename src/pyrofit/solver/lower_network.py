"""From reactions in words to the arrays of the kernels, for all sets of parameters at once."""

import itertools
from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.numerics import functions
from pyrofit.solver.arrays import BoolArray, FloatArray, IntArray, Network, Value, Values
from pyrofit.solver.lower_property import Numbers, stack, total


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
    kinetics: Numbers
    """The numbers of `_KINETICS` of each reaction."""
    heats: Numbers
    """The numbers of `_HEATS`, likewise."""
    yields: Numbers
    """Of each reaction that of every component."""
    follows_A: bool
    """Whether the factor of every rate is A."""
    reactant: IntArray
    residue: IntArray
    plain: bool
    """Whether every reaction has its own reactant and at most one, inert, product."""


_OXYGEN = "oxygen_order", "oxygen_depth_m", "oxygen_use"
_KINETICS = "A_1_s", "order", "catalysis", "E_J_mol", *_OXYGEN
_HEATS = "heat_of_reaction_J_kg", "heat_of_combustion_J_kg"


def _plan(material: words.Material, left_out: Collection[str]) -> _Plan:
    """Return the plan of a network in which some of the `_HEATS` are zero."""
    names = list(material.components)
    reactions = tuple(material.reactions[name] for name in material.reaction_order())
    reactant = [names.index(r.reactant) for r in reactions]
    products = [(j, names.index(name)) for j, r in enumerate(reactions) for name in r.products]
    formed = dict(reversed(products))
    return _Plan(
        reactions=reactions,
        kinetics=Numbers(getattr(r, name) or 0.0 for name in _KINETICS for r in reactions),
        heats=Numbers(
            0.0 if name in left_out else getattr(r, name) for name in _HEATS for r in reactions
        ),
        yields=Numbers(r.products.get(name, 0.0) for r in reactions for name in names),
        follows_A=not material.oxidises and all(r.A_1_s is not None for r in reactions),
        reactant=np.array(reactant, dtype=np.int64),
        residue=np.array([formed.get(j, 0) for j in range(len(reactions))], dtype=np.int64),
        plain=len(set(reactant)) == len(reactions)
        and len(formed) == len(products)
        and not any(i in reactant for _, i in products),
    )


def _kinetics(rows: FloatArray) -> dict[str, Any]:
    """Return what of a network follows from its `_KINETICS`."""
    numbers = rows.reshape(len(_KINETICS), -1, rows.shape[-1])
    factor, order, catalysis, energy, oxygen_order, depth, use = numbers
    catalysed = bool(np.count_nonzero(catalysis))
    return {
        "root_factor": np.sqrt(factor),
        "activation_temperature": energy / GAS_CONSTANT,
        "order": order,
        "catalysis": catalysis,
        "oxygen_order": oxygen_order,
        "oxygen_fall": oxygen_order / depth,
        "oxygen_use": use,
        "first_order": not (catalysed or np.count_nonzero(order != 1.0)),
        "catalysed": catalysed,
    }


def _solid(plan: _Plan, components: int, rows: FloatArray) -> dict[str, Any]:
    """Return what of a network follows from its yields."""
    count = len(plan.reactions)
    yields = rows.reshape(count, components, rows.shape[-1])
    return {
        "yields": yields,
        "gas": 1.0 - total(yields.swapaxes(0, 1)),
        "residue_yield": yields[np.arange(count), plan.residue],
    }


def is_separate(network: Network) -> BoolArray:
    """Tell whether each reaction is solved exactly from k dt alone, shape (sets,).

    None feeds or starves another one, and none of another order than the first is catalysed.
    """
    running = network.root_factor > 0.0
    mixed = running & (network.catalysis > 0.0) & (network.order != 1.0)
    separate: BoolArray = ~np.any(mixed, axis=0)
    for (j, a), (k, b) in itertools.permutations(enumerate(network.reactant.tolist()), 2):
        fed = network.yields[j, b] > 0.0
        separate &= ~(running[j] & running[k] & (fed | (a == b)))
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
    the mass of a sample whose temperature is prescribed depends on neither. The heat release of
    reactions with oxygen takes their heats of reaction in any case. ``oxygen`` is the
    volume fraction in a gas that reaches all of the sample. That of a slab is 1 where the kernel
    takes its fall over depth and time into account, and 0 where there is none.
    """
    heats |= burning and material.oxidises and oxygen != 0.0
    left_out = tuple(name for name, used in zip(_HEATS, (heats, burning), strict=True) if not used)
    plan = material.derived(("network", left_out), lambda m: _plan(m, left_out))
    rates = plan.kinetics.lowered(values, sets, _kinetics)
    solid = plan.yields.lowered(values, sets, partial(_solid, plan, len(material.components)))
    if not plan.follows_A:
        factor = stack([rate_factor(r, values) for r in plan.reactions], sets)
        if material.oxidises:
            factor *= stack([oxygen_factor(r, oxygen, values) for r in plan.reactions], sets)
        rates = {**rates, "root_factor": np.sqrt(factor)}
    heat, burnt = plan.heats.rows(values, sets).reshape(2, -1, sets)
    glow = np.zeros(heat.shape)
    if material.oxidises:
        glow = np.where(rates["oxygen_order"] > 0.0, np.maximum(-heat, 0.0), glow)
    return Network(
        reactant=plan.reactant,
        heat=heat,
        combustion=burnt,
        glow=glow,
        burns=False,
        oxidises=material.oxidises and oxygen != 0.0,
        plain=plan.plain,
        residue=plan.residue,
        **rates,
        **solid,
    )
