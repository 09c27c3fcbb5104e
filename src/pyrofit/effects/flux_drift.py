"""The flux drifts steadily."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="flux drift",
    family="apparatus",
    group="flux over time",
    equation="q(t) = q_0(t) max(1 + d t, 0)",
    strength={
        "drift_1_s": Quantity(
            symbol="d",
            label="relative change of the flux per second",
            unit="1/s",
            lower=-3e-4,
            upper=3e-4,
            value=0.0,
            typical=-5e-5,
            plausible=(-0.0001, 0.0001),
        )
    },
    experiment=on("front", {"drift_1_s": "drift_1_s"}),
)
