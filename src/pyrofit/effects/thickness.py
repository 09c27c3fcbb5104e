"""The sample is thicker or thinner than described."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="thickness",
    family="apparatus",
    group="amount of material",
    equation="L = s L_0",
    strength={
        "factor": Quantity(
            symbol="s",
            label="factor on the thickness",
            unit="-",
            lower=0.9,
            upper=1.1,
            value=1.0,
            typical=1.02,
            plausible=(0.95, 1.05),
            source="assumed range; 0.02 is usual",
        )
    },
    experiment=on("sample", {"thickness_factor": "factor"}),
    of_sample=True,
)
