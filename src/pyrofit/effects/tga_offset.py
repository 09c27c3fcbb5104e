"""The sample of a TGA is hotter or colder than recorded, by the same at every heating rate."""

from pyrofit.effects.base import Effect, Quantity, has_programme, on

EFFECT = Effect(
    title="TGA temperature offset",
    family="apparatus",
    group="temperature of the TGA sample",
    equation="T_sample(t) = T(t) + dT",
    strength={
        "offset_K": Quantity(
            symbol="dT",
            label="temperature of the sample minus the recorded one",
            unit="K",
            lower=-15.0,
            upper=15.0,
            value=0.0,
            typical=4.0,
            plausible=(-9.0, 9.0),
            source="MaCFP PMMA: half of the mass is lost at 630 to 643 K by laboratory, at "
            "10 K/min and equal widths",
        )
    },
    experiment=on("", {"temperature_offset_K": "offset_K"}),
    needs=has_programme,
)
