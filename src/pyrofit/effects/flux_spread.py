"""The flux differs over the surface.

A flux that falls with the square of the radius, by the share d to the edge of a round sample, is a
spread of d/(2 - d) beside a `flux_level` of 1 - d/2.
"""

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
            plausible=(0.0, 0.1),
            source="assumed range; 0.02 to 0.06 is usual. A flux 1 - d (r/R)^2 has the spread "
            "d/(2 - d) and the mean 1 - d/2",
        )
    },
    experiment=on("front", {"spread": "spread"}),
)
