"""The foil on the back, and all that moves with its temperature, has more or less heat capacity."""

from pyrofit.effects.base import Effect, Quantity, has_foil, on

EFFECT = Effect(
    title="heat capacity behind the sample",
    family="apparatus",
    group="heat capacity of the foil",
    equation="s rho c delta dT/dt = q_in - q_out",
    strength={
        "factor": Quantity(
            symbol="s",
            label="factor on the heat capacity of the foil",
            unit="-",
            lower=0.0,
            upper=40.0,
            value=1.0,
            typical=4.0,
            plausible=(0.5, 4.0),
            source="MaCFP PMMA: foil of 0.025 mm; 0.2 mm have been used in models of it",
        )
    },
    experiment=on("sample.foil", {"mass_factor": "factor"}),
    needs=has_foil,
    check="weigh foil, adhesive and holder, and state their heat capacity per area",
)
