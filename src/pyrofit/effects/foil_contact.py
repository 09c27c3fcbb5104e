"""Heat passes from the sample to the foil through a resistance."""

from pyrofit.effects.base import Effect, Quantity, has_foil, on

EFFECT = Effect(
    title="contact of the foil",
    family="apparatus",
    group="contact to the foil",
    equation="q = (T_sample - T_foil) / R",
    strength={
        "resistance_m2K_W": Quantity(
            symbol="R",
            label="contact resistance of the foil",
            unit="m2 K/W",
            lower=0.0,
            upper=5e-3,
            value=0.0,
            typical=5e-4,
            plausible=(0.0, 0.001),
            source="assumed range; 0.02 mm of epoxy have 1e-4 m2 K/W",
        )
    },
    experiment=on("sample.foil", {"contact_m2K_W": "resistance_m2K_W"}),
    needs=has_foil,
)
