"""The conductivity of the material's components changes with temperature."""

from pyrofit.effects.base import Effect, Quantity
from pyrofit.effects.substance import properties_changed

EFFECT = Effect(
    title="slope of the conductivity",
    family="material",
    group="conductivity with temperature",
    equation="k(T) = k max(0.01, 1 + b (T - 475 K))",
    strength={
        "slope_1_K": Quantity(
            symbol="b",
            label="relative slope of the conductivity",
            unit="1/K",
            lower=-2e-3,
            upper=5e-3,
            value=0.0,
            typical=-1e-3,
            source="MaCFP PMMA: UMD's has -3e-3 1/K above 395 K",
        )
    },
    components=properties_changed("conductivity_W_mK", slope_1_K="slope_1_K"),
)
