"""From reactions in words to the arrays of the kernels, for all sets of parameters at once."""

from dataclasses import dataclass

import numpy as np

from pyrofit.constants import GAS_CONSTANT
from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.numerics import functions
from pyrofit.solver.arrays import BoolArray, IntArray, Network, Value, Values
from pyrofit.solver.lower_property import stack, total


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
