"""The flux differs over the surface."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="flux spread",
    family="apparatus",
    group="flux over the surface",
    equation="y = mean of y(q) over q_0 (1 - s) to q_0 (1 + s)",
    strength={
        "spread": Quantity(
            symbol="s",
            label="half the relative spread of the flux",
            unit="-",
            lower=0.0,
            upper=0.3,
            value=0.0,
            typical=0.06,
            source="assumed range; 0.02 to 0.06 is usual",
        )
    },
    experiment=on("front", {"spread": "spread"}),
)
