"""The back loses more or less heat by convection."""

from pyrofit.effects.base import Effect, Quantity, has_open_back, on

EFFECT = Effect(
    title="back convection",
    family="environment",
    group="back loss",
    equation="h = max(h_0 + dh, 0)",
    strength={
        "change_W_m2K": Quantity(
            symbol="dh",
            label="change of the back's heat transfer coefficient",
            unit="W/(m2 K)",
            lower=-10.0,
            upper=20.0,
            value=0.0,
            typical=4.0,
            plausible=(-4.0, 8.0),
            source="MaCFP PMMA: 4 W/(m2 K) in UMD's apparatus, an average",
        )
    },
    experiment=on("back", {"h_change_W_m2K": "change_W_m2K"}),
    needs=has_open_back,
)
