"""Radiation is absorbed in depth instead of at the surface; the transmitted part is lost."""

from pyrofit.effects.base import Effect, has_no_backing, on
from pyrofit.effects.in_depth import LENGTH
from pyrofit.effects.substance import refuse_translucent

EFFECT = Effect(
    title="in-depth absorption, transmission lost",
    family="material",
    group="absorption in depth",
    equation="q''' = eps q exp(-z/l)/l; eps q exp(-L/l) leaves the sample",
    strength={"length_m": LENGTH},
    material=refuse_translucent,
    experiment=on("sample", {"absorption_length_m": "length_m"}, transmitted="lost"),
    of_sample=True,
    distinct_in=has_no_backing,
)
