"""Reactions as steps of one product each, for programs whose reactions have no more.

A reaction A -> sum_i nu_i P_i + gas of the rate constant k is the same as competing reactions
A -> P_i with nu_i k, and A -> gas with the rest: their shares do not change with temperature.
"""

from typing import NamedTuple

from pyrofit.model.base import value_of
from pyrofit.model.material import Material, Reaction
from pyrofit_exchange.fds.materials import Values, factor_with
from pyrofit_exchange.fds.remarks import Remark


class StepReaction(NamedTuple):
    """A reaction of one product.

    Parameters
    ----------
    reactant, product
        Components; no product = gas alone.
    A_1_s, E_J_mol, order
        Kinetics.
    heat_J_kg
        Heat of the whole reaction per kg of reactant, positive = endothermic.
    share
        Share of the reaction that this step is.
    """

    reactant: str
    product: str | None
    A_1_s: float
    E_J_mol: float
    order: float
    heat_J_kg: float
    share: float


def oxidises(reaction: Reaction, values: Values) -> bool:
    """Tell whether a reaction needs oxygen: the files for other programs leave it out."""
    return value_of(reaction.oxygen_order, values) > 0.0


def left_out(material: Material, values: Values) -> list[Remark]:
    """Name the reactions that need oxygen."""
    return [
        Remark("left out", f"reaction '{name}', which needs oxygen (oxygen_order)", "not written")
        for name, reaction in material.reactions.items()
        if oxidises(reaction, values)
    ]


def steps_of(material: Material, values: Values, names: list[str], R: float) -> list[StepReaction]:
    """Return the steps of all reactions of the named components that run at all.

    Parameters
    ----------
    material, values
        The description and its numbers, SI units.
    names
        Components that are there.
    R
        Gas constant of the program [J/(mol K)].
    """
    found = []
    for name in material.reaction_order():
        reaction = material.reactions[name]
        A = factor_with(reaction, values, R)
        if reaction.reactant not in names or A <= 0.0 or oxidises(reaction, values):
            continue
        shares: dict[str | None, float] = {
            product: value_of(nu, values) for product, nu in reaction.products.items()
        }
        shares[None] = 1.0 - sum(shares.values())
        E, order, heat = (
            value_of(x, values)
            for x in (reaction.E_J_mol, reaction.order, reaction.heat_of_reaction_J_kg)
        )
        found += [
            StepReaction(reaction.reactant, product, share * A, E, order, heat, share)
            for product, share in shares.items()
            if share > 1e-12
        ]
    return found
