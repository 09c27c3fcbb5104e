"""Part of the radiation is absorbed at the surface, the rest, of another band, in depth."""

from pyrofit.effects.base import Effect, Quantity
from pyrofit.effects.in_depth import LENGTH, absorbed_behind
from pyrofit.effects.substance import refuse_translucent

EFFECT = Effect(
    title="in-depth absorption of one band",
    family="material",
    group="absorption in depth",
    equation="q''' = (1 - f) eps q exp(-z/l)/l, the surface absorbs f eps q, "
    "back face or foil (1 - f) eps q exp(-L/l)",
    strength={"length_m": LENGTH},
    form={
        "surface_share": Quantity(
            symbol="f",
            label="share of the radiation that the surface absorbs",
            unit="-",
            lower=0.0,
            upper=1.0,
            value=0.4,
            typical=0.7,
            source="assumed range. PMMA absorbs infrared beyond 2.2 um within 0.1 mm, below 2.2 um "
            "within millimetres: Linteris et al. 2012, doi:10.1002/fam.1113",
        )
    },
    material=refuse_translucent,
    experiment=lambda experiment, at: absorbed_behind(
        experiment, at, absorption_length_m="length_m", surface_share="surface_share"
    ),
    of_sample=True,
)
