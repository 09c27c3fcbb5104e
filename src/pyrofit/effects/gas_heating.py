"""The gas before the front heats up during the test."""

from pyrofit.effects.base import Effect, Quantity, on
from pyrofit.effects.gas_temperature import RISE

EFFECT = Effect(
    title="gas heating up",
    family="environment",
    group="front loss",
    equation="T_gas(t) = T_gas,0 + dT (1 - exp(-t/tau))",
    strength={"rise_K": RISE},
    form={
        "time_s": Quantity(
            symbol="tau",
            label="time constant of the gas temperature",
            unit="s",
            lower=5.0,
            upper=1000.0,
            value=200.0,
            typical=60.0,
        )
    },
    experiment=on("front", {"gas_rise_K": "rise_K", "gas_rise_time_s": "time_s"}),
)
