"""The sample of a TGA lags behind the temperature that is recorded."""

from pyrofit.effects.base import Effect, Quantity, has_programme, on

EFFECT = Effect(
    title="TGA temperature lag",
    family="apparatus",
    group="temperature of the TGA sample",
    equation="T_sample(t) = T(t) - beta tau",
    strength={
        "time_s": Quantity(
            symbol="tau",
            label="time by which the sample lags behind",
            unit="s",
            lower=0.0,
            upper=20.0,
            value=0.0,
            typical=5.0,
            plausible=(0.0, 10.0),
            source="assumed range; a lag grows with rate and mass: "
            "Vyazovkin et al. 2014, doi:10.1016/j.tca.2014.05.036",
        )
    },
    experiment=on("", {"lag_s": "time_s"}),
    needs=has_programme,
)
