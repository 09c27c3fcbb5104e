"""The flux is higher or lower than stated, by the same factor throughout."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="flux level",
    family="apparatus",
    group="amount of flux",
    equation="q(t) = s q_0(t)",
    strength={
        "factor": Quantity(
            symbol="s",
            label="factor on the external flux",
            unit="-",
            lower=0.85,
            upper=1.15,
            value=1.0,
            typical=1.03,
            plausible=(0.94, 1.06),
            source="heat flux gauges are calibrated to about 0.03: "
            "Pitts et al. 2006, doi:10.1016/j.firesaf.2006.04.004",
        )
    },
    experiment=on("front", {"flux_factor": "factor"}),
)
