"""The specific heat of the material's components changes with temperature."""

from pyrofit.effects.base import Effect, Quantity, takes_up_heat
from pyrofit.effects.substance import properties_changed

EFFECT = Effect(
    title="slope of the specific heat",
    family="material",
    group="heat capacity with temperature",
    equation="c(T) = c max(0.01, 1 + b (T - 475 K))",
    strength={
        "slope_1_K": Quantity(
            symbol="b",
            label="relative slope of the specific heat",
            unit="1/K",
            lower=-1e-3,
            upper=5e-3,
            value=0.0,
            typical=1e-3,
            source="MaCFP PMMA: UMD's has 1.3e-3 1/K above 395 K; "
            "Stoliarov et al. 2009, doi:10.1016/j.combustflame.2008.11.010",
        )
    },
    components=properties_changed("specific_heat_J_kgK", slope_1_K="slope_1_K"),
    needs=takes_up_heat,
)
