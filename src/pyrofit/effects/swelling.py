"""All components of the material swell."""

from pyrofit.effects.base import Effect, Quantity
from pyrofit.effects.substance import properties_changed

EFFECT = Effect(
    title="swelling",
    family="material",
    group="swelling",
    equation="V(T) = V_0 (1 + s / (1 + exp(-(T - T_s)/w)))",
    strength={
        "step": Quantity(
            symbol="s",
            label="relative rise of the volume",
            unit="-",
            lower=0.0,
            upper=9.0,
            value=0.0,
            typical=0.3,
            source="assumed range; polymers foam to 3 to 10 times their volume, "
            "MaCFP PMMA is fitted best by 1.3 to 2.5 times",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_s",
            label="temperature of swelling",
            unit="K",
            lower=350.0,
            upper=700.0,
            value=550.0,
            typical=500.0,
        ),
        "width_K": Quantity(
            symbol="w",
            label="width of swelling",
            unit="K",
            lower=2.0,
            upper=60.0,
            value=15.0,
            typical=40.0,
        ),
    },
    components=properties_changed(
        "expansion",
        step="step",
        step_temperature_K="temperature_K",
        step_width_K="width_K",
    ),
)
