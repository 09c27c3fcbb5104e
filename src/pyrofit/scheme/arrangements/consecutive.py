"""Each reaction forms an intermediate that the next one consumes."""

from collections.abc import Sequence

from pyrofit.effects.base import changed
from pyrofit.model.material import REST, Material, Reaction
from pyrofit.scheme.arrangements.base import PREFIX, Arrangement, Limits, Template, numbered

_MARGIN = 0.01
"""Least yield of gas of the first reaction."""


def _build(template: Template, reactions: Sequence[Reaction]) -> Material:
    names = [numbered(template, i + 1) for i in range(len(reactions))]
    made = {}
    for i, (name, reaction) in enumerate(zip(names, reactions, strict=True), 1):
        # The solid residue forms in the first reaction: its yield is that of the virgin material.
        products: dict[str, float | str] = dict(template.products) if i == 1 else {}
        if i < len(names):
            products[names[i]] = f"{PREFIX}y_{i + 1}"
        # ASSUME: the first reaction takes all the heat.
        heat = reaction.heat_of_reaction_J_kg if i == 1 else 0.0
        update = {"reactant": name, "products": products, "heat_of_reaction_J_kg": heat}
        made[name] = changed(reaction, **update)
    return Material(
        components={**dict.fromkeys(names, template.component), **template.inert},
        reactions=made,
        composition={**template.composition, template.reactant: REST},
    )


def _shares(i: int, count: int, template: Template) -> dict[str, Limits]:
    upper = 1.0 - _MARGIN - (template.residue if i == 2 else 0.0)
    return {f"y_{i}": Limits("-", 0.01, upper, f"yield of intermediate {i - 1}")}


ARRANGEMENT = Arrangement(
    equation="m_1 -> y_2 m_2 + gas, m_2 -> y_3 m_3 + gas, ..., r_i = k_i m_0 (m_i/m_0)^n_i",
    build=_build,
    shares=_shares,
)
