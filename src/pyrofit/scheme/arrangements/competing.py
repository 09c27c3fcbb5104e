"""Reactions that consume the same component; each leaves a residue of its own."""

from collections.abc import Sequence

from pyrofit.effects.base import changed
from pyrofit.model.material import REST, Material, Reaction
from pyrofit.scheme.arrangements.base import PREFIX, Arrangement, Limits, Template, numbered

_LARGEST = 0.6
"""Largest solid yield of a further reaction."""


def _build(template: Template, reactions: Sequence[Reaction]) -> Material:
    made = {}
    for i, reaction in enumerate(reactions, 1):
        products: dict[str, float | str] = dict(template.products)
        if i > 1:
            products = dict.fromkeys(list(products)[:1], f"{PREFIX}y_{i}")
        update = {"reactant": template.reactant, "products": products}
        made[numbered(template, i)] = changed(reaction, **update)
    return Material(
        components={template.reactant: template.component, **template.inert},
        reactions=made,
        composition={**template.composition, template.reactant: REST},
    )


def _shares(i: int, count: int, template: Template) -> dict[str, Limits]:
    if not template.products:
        return {}
    return {f"y_{i}": Limits("-", 0.0, _LARGEST, f"solid yield of reaction {i}")}


ARRANGEMENT = Arrangement(
    equation="dm/dt = -m_0 sum_i k_i (m/m_0)^n_i, reaction i forms y_i of solid",
    build=_build,
    shares=_shares,
)
