"""The main reaction is not of first order."""

from pyrofit.effects.base import Effect, Numbers, Quantity, reacts
from pyrofit.effects.substance import main_reaction, with_main
from pyrofit.model.material import Material


def _change(material: Material, at: Numbers) -> Material:
    name, reaction = main_reaction(material)
    if reaction.order != 1.0:
        raise ValueError(f"reaction '{name}' has the order {reaction.order!r} already")
    return with_main(material, order=at["order"])


EFFECT = Effect(
    title="reaction order",
    family="material",
    group="reactions",
    equation="r = k m_0 (m/m_0)^n",
    strength={
        "order": Quantity(
            symbol="n",
            label="order of the main reaction",
            unit="-",
            lower=0.3,
            upper=3.0,
            value=1.0,
            typical=1.3,
            source="MaCFP PMMA: groups use 0.87 to 3.56; "
            "Vyazovkin et al. 2011, doi:10.1016/j.tca.2011.03.034",
        )
    },
    material=_change,
    needs=reacts,
    keeps=("order",),
)
