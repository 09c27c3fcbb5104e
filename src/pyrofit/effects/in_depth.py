"""Radiation is absorbed in depth instead of at the surface; a foil absorbs what passes through."""

from pyrofit.effects.base import Effect, Quantity, on
from pyrofit.effects.substance import refuse_translucent

LENGTH = Quantity(
    symbol="l",
    label="absorption length",
    unit="m",
    lower=0.0,
    upper=2e-3,
    value=0.0,
    typical=3.5e-4,
    source="MaCFP PMMA: kappa/rho = 2.38 m2/kg, groups use 2250 to 3421 1/m; "
    "Linteris et al. 2012, doi:10.1002/fam.1113",
)
EFFECT = Effect(
    title="in-depth absorption",
    family="material",
    group="absorption in depth",
    equation="q''' = eps q exp(-z/l)/l; the foil absorbs eps q exp(-L/l)",
    strength={"length_m": LENGTH},
    material=refuse_translucent,
    experiment=on("sample", {"absorption_length_m": "length_m"}),
    of_sample=True,
)
