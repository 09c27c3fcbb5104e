"""The gas before the front is hotter than described."""

from pyrofit.effects.base import Effect, Quantity, on

RISE = Quantity(
    symbol="dT",
    label="rise of the gas temperature before the front",
    unit="K",
    lower=-50.0,
    upper=300.0,
    value=0.0,
    typical=50.0,
    plausible=(-50.0, 150.0),
    source="MaCFP PMMA: averages of 330 K at 25 kW/m2 and 365 K at 60 kW/m2",
)
EFFECT = Effect(
    title="gas temperature",
    family="environment",
    group="front loss",
    equation="T_gas = T_gas,0 + dT",
    strength={"rise_K": RISE},
    experiment=on("front", {"gas_rise_K": "rise_K"}),
)
