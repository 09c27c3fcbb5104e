"""All components of the material take up a heat of melting."""

from pyrofit.effects.base import Effect, Quantity, takes_up_heat
from pyrofit.effects.substance import properties_changed

EFFECT = Effect(
    title="melting",
    family="material",
    group="heat capacity with temperature",
    equation="c(T) = c + dh_m exp(-((T - T_m)/w)^2/2) / (sqrt(2 pi) w)",
    strength={
        "heat_J_kg": Quantity(
            symbol="dh_m",
            label="heat of melting",
            unit="J/kg",
            lower=0.0,
            upper=2.5e5,
            value=0.0,
            typical=5e4,
            source="assumed range; amorphous polymers 0, polyethylene about 2e5 J/kg",
        )
    },
    form={
        "temperature_K": Quantity(
            symbol="T_m",
            label="melting temperature",
            unit="K",
            lower=350.0,
            upper=600.0,
            value=450.0,
            typical=420.0,
        ),
        "width_K": Quantity(
            symbol="w",
            label="standard deviation of the melting peak",
            unit="K",
            lower=6.0,
            upper=40.0,
            value=15.0,
            typical=25.0,
        ),
    },
    components=properties_changed(
        "specific_heat_J_kgK",
        peak_area="heat_J_kg",
        peak_temperature_K="temperature_K",
        peak_width_K="width_K",
    ),
    needs=takes_up_heat,
)
