"""Components and reactions as MATL and RAMP lines."""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from pyrofit.constants import GAS_CONSTANT, STEFAN_BOLTZMANN
from pyrofit.errors import StudyError
from pyrofit.model.base import value_of
from pyrofit.model.material import Component, Material, Reaction
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.lower_property import LEAST_SHARE
from pyrofit_exchange.fds.namelists import Item, Namelist, unique
from pyrofit_exchange.fds.orders import first_order_sum, same_half_time
from pyrofit_exchange.fds.properties import tabulated, written
from pyrofit_exchange.fds.remarks import Remark
from pyrofit_exchange.fds.versions import Version

NO_CATALYSIS = (
    "the reaction of '{}' is autocatalytic (`catalysis`): files of other programs cannot hold its "
    "rate; describe it by several reactions, or by an order"
)
R_FDS = 8.314472
"""Molar gas constant of FDS [J/(mol K)]."""
REFERENCE_RATE_1_S = 1e-3
"""Rate at which FDS and pyrofit agree to the last digit in spite of another gas constant."""
MOST_RAMP, MOST_ID = 30, 40
"""Characters of an identifier; FDS cuts longer ones without a word."""
SUM = "first-order parts"
"""The substitute for a reaction of another order."""
OPAQUE_1_M = 1e7
"""Absorption coefficient behind a translucent sample; FDS's default lets radiation pass a foil."""
Values = Mapping[str, float]


@dataclass(frozen=True)
class MaterialLines:
    """The lines of some components.

    Parameters
    ----------
    namelists
        MATL and RAMP lines.
    parts
        By component the identifiers of its MATL lines and their shares of its mass. There are
        several where a sum of first-order reactions stands for one of another order.
    remarks
        The terms that are not written exactly.
    """

    namelists: tuple[Namelist, ...]
    parts: Mapping[str, tuple[tuple[str, float], ...]]
    remarks: tuple[Remark, ...]


@dataclass(frozen=True)
class Options:
    """How components are written.

    Parameters
    ----------
    version
        Version of FDS.
    gas
        Identifier of the gas that reactions form.
    absorption_1_m
        Absorption coefficients of FDS by component of a translucent sample; none = opaque.
    """

    version: Version
    gas: str = "METHANE"
    absorption_1_m: Mapping[str, float] = field(default_factory=dict)


def reached_components(material: Material, names: Iterable[str]) -> list[str]:
    """Return components and their reaction products, in the order of the material."""
    found = set(names)
    for reaction in (material.reactions[n] for n in material.reaction_order()):
        if reaction.reactant in found:
            found |= set(reaction.products)
    return [name for name in material.components if name in found]


def write_materials(
    material: Material, values: Values, names: Collection[str], options: Options
) -> MaterialLines:
    """Return the lines of the named components and of their reaction products."""
    chosen = reached_components(material, names)
    remarks: list[Remark] = []
    split = {name: first_order_parts(material, values, name, remarks) for name in chosen}
    keys = [
        f"{name}{k + 1}" if len(of) > 1 else name
        for name, of in split.items()
        for k in range(len(of))
    ]
    ids = iter(unique(keys, MOST_ID).values())
    named = {name: [(next(ids), *pair) for pair in of] for name, of in split.items()}
    first = {name: of[0][0] for name, of in named.items()}
    namelists: list[Namelist] = []
    ramps = unique([f"{kind}_{name}" for name in chosen for kind in "KC"], MOST_RAMP)
    for name, of in named.items():
        thermal, lines = _thermal(material, values, name, ramps, options, remarks)
        for identifier, _, rate in of:
            reactions = _reactions(material, values, name, first, options, rate, remarks)
            items = {"ID": identifier, **thermal, **dict(reactions)}
            namelists.append(Namelist("MATL", items))
        namelists += lines
    parts = {name: tuple((i, w) for i, w, _ in of) for name, of in named.items()}
    return MaterialLines(tuple(namelists), parts, tuple(remarks))


def _own(material: Material, values: Values, name: str) -> list[tuple[str, Reaction]]:
    """Return the reactions of a component that run at all."""
    found = [(n, r) for n, r in material.reactions.items() if r.reactant == name]
    return [(n, r) for n, r in found if factor_with(r, values) > 0.0]


def first_order_parts(
    material: Material, values: Values, name: str, remarks: list[Remark]
) -> tuple[tuple[float, float], ...]:
    """Return shares and relative rates of the first-order parts that a component is split into."""
    own = _own(material, values, name)
    formed = any(name in r.products for r in material.reactions.values())
    orders = [value_of(r.order, values) for _, r in own]
    if len(own) == 1 and orders[0] > 1.0 + 1e-6 and not formed:
        parts = first_order_sum(round(orders[0], 9))
        how = f"{len(parts)} {SUM}, mass within 1E-3 of the exact one"
        remarks.append(Remark("approximate", _of_order(own[0][0], orders[0]), how))
        return parts
    for (reaction, _), order in zip(own, orders, strict=True):
        if abs(order - 1.0) > 1e-6:
            why = (
                "of a product"
                if formed
                else "of competing reactions"
                if len(own) > 1
                else "below 1"
            )
            how = f"an order {why} cannot be written; first order that reaches one half as early"
            remarks.append(Remark("approximate", _of_order(reaction, order), how))
    return ((1.0, 1.0),)


def _of_order(reaction: str, order: float) -> str:
    return f"order {order:.4g} of reaction '{reaction}' (reactions.{reaction}.order)"


def _thermal(
    material: Material,
    values: Values,
    name: str,
    ramps: Mapping[str, str],
    options: Options,
    remarks: list[Remark],
) -> tuple[dict[str, Item], list[Namelist]]:
    """Return density, conductivity, specific heat and emissivity of a component, and its ramps."""
    component = material.components[name]
    kappa = options.absorption_1_m.get(name)

    def less_radiation(T: FloatArray, k: FloatArray) -> FloatArray:
        radiation = 4.0 * STEFAN_BOLTZMANN * (T * T * T) / (kappa or 1.0)
        return np.maximum(k - radiation, LEAST_SHARE * k)

    k = tabulated(component.conductivity_W_mK, values, less_radiation if kappa else None)
    c = tabulated(component.specific_heat_J_kgK, values)
    conductivity, lines = written("CONDUCTIVITY", ramps[f"K_{name}"], k, 1.0)
    heat, more = written("SPECIFIC_HEAT", ramps[f"C_{name}"], c, 1e-3)
    items: dict[str, Item] = {
        "DENSITY": value_of(component.density_kg_m3, values),
        **conductivity,
        **heat,
        "EMISSIVITY": value_of(component.emissivity, values),
    }
    if options.absorption_1_m:
        items["ABSORPTION_COEFFICIENT"] = kappa or OPAQUE_1_M
    remarks += _unwritten(name, component, values, bool(kappa))
    return items, lines + more


def _unwritten(
    name: str, component: Component, values: Values, translucent: bool
) -> Iterator[Remark]:
    """Yield the properties of a component that have no key in FDS."""
    if np.any(np.abs(tabulated(component.expansion, values) - 1.0) > 1e-9):
        what = f"swelling of '{name}' (components.{name}.expansion)"
        yield Remark("left out", what, "a layer of FDS does not swell with temperature")
    if translucent and np.ptp(tabulated(component.absorption_factor, values)) > 1e-9:
        what = f"absorption of '{name}' that changes with temperature (absorption_factor)"
        yield Remark("left out", what, "an absorption coefficient of FDS is constant")


def factor_with(reaction: Reaction, values: Values, R: float = R_FDS) -> float:
    """Return A [1/s] that has the same rate with another gas constant R [J/(mol K)].

    Raises
    ------
    StudyError
        The reaction is autocatalytic: no other program's files hold such a rate.
    """
    if value_of(reaction.catalysis, values) > 0.0:
        raise StudyError(NO_CATALYSIS.format(reaction.reactant))
    E = value_of(reaction.E_J_mol, values)
    if reaction.A_1_s is None:
        assert reaction.reference_rate_1_s is not None
        assert reaction.reference_temperature_K is not None
        rate = value_of(reaction.reference_rate_1_s, values)
        return rate * math.exp(E / (R * value_of(reaction.reference_temperature_K, values)))
    A = value_of(reaction.A_1_s, values)
    if A <= REFERENCE_RATE_1_S:
        return A
    # The same k at the temperature of the reference rate: E / (R T) = ln(A / k) there.
    return REFERENCE_RATE_1_S * math.exp(math.log(A / REFERENCE_RATE_1_S) * GAS_CONSTANT / R)


def _reactions(
    material: Material,
    values: Values,
    name: str,
    first: Mapping[str, str],
    options: Options,
    rate: float,
    remarks: list[Remark],
) -> Iterator[tuple[str, Item]]:
    """Yield the keys of a component's reactions; A is multiplied by ``rate``."""
    own = [r for _, r in _own(material, values, name)]
    if not own:
        return
    if options.version.adjusts_heat:
        yield "ADJUST_H", False
    yield "N_REACTIONS", len(own)
    is_sum = rate != 1.0
    for j, reaction in enumerate(own, 1):
        factor = rate if is_sum else same_half_time(value_of(reaction.order, values))
        yield f"A({j})", factor * factor_with(reaction, values)
        yield f"E({j})", value_of(reaction.E_J_mol, values)
        yield f"N_S({j})", 1.0
        if oxygen_order := value_of(reaction.oxygen_order, values):
            yield f"N_O2({j})", oxygen_order
            yield f"GAS_DIFFUSION_DEPTH({j})", value_of(reaction.oxygen_depth_m, values)
            if use := value_of(reaction.oxygen_use, values):
                what = f"oxygen used up in '{name}' ({use:g} kg/kg, oxygen_use)"
                remarks.append(Remark("left out", what, "the solid phase alone keeps its oxygen"))
        yield from _products(reaction, values, first, options.gas, j)
        yield f"HEAT_OF_REACTION({j})", 1e-3 * value_of(reaction.heat_of_reaction_J_kg, values)


def _products(
    reaction: Reaction, values: Values, first: Mapping[str, str], gas: str, j: int
) -> Iterator[tuple[str, Item]]:
    """Yield the yields of a reaction; as they are printed they add up to 1."""
    yields = {product: value_of(nu, values) for product, nu in reaction.products.items()}
    solid = {product: round(nu, 9) for product, nu in yields.items() if nu > 0.0}
    rest = round(1.0 - sum(solid.values()), 9)
    if rest > 0.0:
        yield f"SPEC_ID(1,{j})", gas
        yield f"NU_SPEC(1,{j})", rest
    for i, (product, nu) in enumerate(solid.items(), 1):
        yield f"MATL_ID({i},{j})", first[product]
        yield f"NU_MATL({i},{j})", nu
