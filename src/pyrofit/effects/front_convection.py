"""The front loses more or less heat by convection."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="front convection",
    family="environment",
    group="front loss",
    equation="h = max(h_0 + dh, 0)",
    strength={
        "change_W_m2K": Quantity(
            symbol="dh",
            label="change of the front's heat transfer coefficient",
            unit="W/(m2 K)",
            lower=-8.6,
            upper=25.0,
            value=0.0,
            typical=4.0,
            plausible=(-5.0, 8.0),
            source="MaCFP PMMA: 8.6 W/(m2 K) in UMD's apparatus, an average",
        )
    },
    experiment=on("front", {"h_change_W_m2K": "change_W_m2K"}),
)
