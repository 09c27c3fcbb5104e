"""Several components decompose side by side, each by a reaction of its own."""

from collections.abc import Sequence

from pyrofit.effects.base import changed
from pyrofit.model.material import REST, Material, Reaction
from pyrofit.scheme.arrangements.base import PREFIX, Arrangement, Limits, Template, numbered


def _build(template: Template, reactions: Sequence[Reaction]) -> Material:
    names = [numbered(template, i + 1) for i in range(len(reactions))]
    composition = {name: f"{PREFIX}w_{i}" for i, name in enumerate(names[1:], 2)}
    return Material(
        components={**dict.fromkeys(names, template.component), **template.inert},
        reactions={
            name: changed(reaction, reactant=name, products=dict(template.products))
            for name, reaction in zip(names, reactions, strict=True)
        },
        composition={**template.composition, **composition, template.reactant: REST},
    )


def _shares(i: int, count: int, template: Template) -> dict[str, Limits]:
    # Numbered by their shares; together they stay below one, and the first component is the rest.
    upper = 0.6 if count == 2 else {2: 0.5, 3: 0.3, 4: 0.19}[i]
    return {f"w_{i}": Limits("-", 0.001, upper, f"mass fraction of component {i}")}


ARRANGEMENT = Arrangement(
    equation="m = sum_i m_i, dm_i/dt = -k_i m_i0 (m_i/m_i0)^n_i, m_i0 = w_i m_0",
    build=_build,
    shares=_shares,
)
