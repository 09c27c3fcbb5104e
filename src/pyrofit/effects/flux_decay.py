"""The flux drifts from its start towards another value."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="flux decay",
    family="apparatus",
    group="flux over time",
    equation="q(t) = q_0(t) max(1 + d tau (1 - exp(-t/tau)), 0)",
    strength={
        "drift_1_s": Quantity(
            symbol="d",
            label="relative change of the flux per second at the start",
            unit="1/s",
            lower=-1e-3,
            upper=1e-3,
            value=0.0,
            typical=-5e-4,
            plausible=(-0.0007, 0.0007),
        )
    },
    form={
        "time_s": Quantity(
            symbol="tau",
            label="time constant of the flux",
            unit="s",
            lower=20.0,
            upper=500.0,
            value=120.0,
            typical=200.0,
        )
    },
    experiment=on("front", {"drift_1_s": "drift_1_s", "drift_time_s": "time_s"}),
)
