"""The back loses more or less heat by convection and radiation; 0 is an insulated back."""

from pyrofit.effects.base import Effect, Quantity, has_open_back, on

EFFECT = Effect(
    title="back loss",
    family="environment",
    group="back loss",
    equation="q_back = s (h (T - T_gas) + eps sigma (T^4 - T_wall^4))",
    strength={
        "factor": Quantity(
            symbol="s",
            label="factor on the heat loss of the back",
            unit="-",
            lower=0.0,
            upper=2.5,
            value=1.0,
            typical=0.5,
            plausible=(0.4, 1.6),
        )
    },
    experiment=on("back", {"loss_factor": "factor"}),
    needs=has_open_back,
)
