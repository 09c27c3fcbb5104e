"""At the glass transition the specific heat rises by a step, and the conductivity bends."""

from pyrofit.effects.base import Effect, Quantity, takes_up_heat
from pyrofit.effects.substance import properties_changed, together

EFFECT = Effect(
    title="glass transition",
    family="material",
    group="heat capacity with temperature",
    equation="c(T) = c + s / (1 + exp(-(T - T_g)/w)), "
    "k(T) = k max(0.01, 1 + r s w ln(1 + exp((T - T_g)/w)))",
    strength={
        "step_J_kgK": Quantity(
            symbol="s",
            label="step of the specific heat",
            unit="J/(kg K)",
            lower=0.0,
            upper=1500.0,
            value=0.0,
            typical=400.0,
            source="MaCFP PMMA: UMD's c(T) to 25 J/(kg K), with 730 J/(kg K) at 361 K, "
            "w = 24 K, slope 1.8e-3 1/K",
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
        "bend_kg_J": Quantity(
            symbol="r",
            label="relative slope of the conductivity above the transition, per step of the "
            "specific heat",
            unit="kg/J",
            lower=-1e-5,
            upper=1e-5,
            value=0.0,
            typical=-4e-6,
            source="MaCFP PMMA: UMD's k bends by -2.6e-3 1/K, over 730 J/(kg K)",
        ),
    },
    components=together(
        properties_changed(
            "specific_heat_J_kgK",
            step="step_J_kgK",
            step_temperature_K="temperature_K",
            step_width_K="width_K",
        ),
        properties_changed(
            "conductivity_W_mK",
            scale="step_J_kgK",
            bend="bend_kg_J",
            step_temperature_K="temperature_K",
            step_width_K="width_K",
        ),
    ),
    needs=takes_up_heat,
)
