"""The heater comes up with a time constant."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="slow heater",
    family="apparatus",
    group="timing",
    equation="q(t) = q_0(t) (1 - exp(-t/tau))",
    strength={
        "time_s": Quantity(
            symbol="tau",
            label="time constant of the heater",
            unit="s",
            lower=0.0,
            upper=40.0,
            value=0.0,
            typical=8.0,
            plausible=(0.0, 15.0),
        )
    },
    experiment=on("front", {"rise_time_s": "time_s"}),
)
