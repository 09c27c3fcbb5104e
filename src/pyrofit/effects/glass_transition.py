"""The specific heat of the material's components rises by a step at the glass transition."""

from pyrofit.effects.base import Effect, Quantity, takes_up_heat
from pyrofit.effects.substance import properties_changed

EFFECT = Effect(
    title="glass transition",
    family="material",
    group="heat capacity with temperature",
    equation="c(T) = c + s / (1 + exp(-(T - T_g)/w))",
    strength={
        "step_J_kgK": Quantity(
            symbol="s",
            label="step of the specific heat",
            unit="J/(kg K)",
            lower=0.0,
            upper=1500.0,
            value=0.0,
            typical=400.0,
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_g",
            label="glass transition temperature",
            unit="K",
            lower=330.0,
            upper=480.0,
            value=390.0,
            typical=378.0,
            source="PMMA: 378 to 395 K, MaCFP PMMA",
        ),
        "width_K": Quantity(
            symbol="w",
            label="width of the glass transition",
            unit="K",
            lower=2.0,
            upper=40.0,
            value=8.0,
            typical=16.0,
        ),
    },
    components=properties_changed(
        "specific_heat_J_kgK",
        step="step_J_kgK",
        step_temperature_K="temperature_K",
        step_width_K="width_K",
    ),
    needs=takes_up_heat,
)
