"""The surface emissivity changes as the sample loses mass."""

from pyrofit.effects.base import Effect, Quantity, on

EFFECT = Effect(
    title="emissivity with conversion",
    family="material",
    group="emissivity with conversion",
    equation="eps = min(max(eps_0 + d (1 - m/m_0), 0), 1)",
    strength={
        "change": Quantity(
            symbol="d",
            label="change of the emissivity until all has reacted",
            unit="-",
            lower=-0.3,
            upper=0.2,
            value=0.0,
            typical=-0.08,
            source="MaCFP PMMA: groups use emissivities of 0.41 to 1.0",
        )
    },
    experiment=on("sample", {"emissivity_change": "change"}),
    of_sample=True,
)
