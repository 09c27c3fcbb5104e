"""The balance drifts, so that the mass loss rate is wrong by a constant."""

from pyrofit.effects.base import Effect, Quantity, need, on
from pyrofit.model.experiment import Experiment


@need("a mass loss rate")
def _has_mlr(experiment: Experiment) -> bool:
    return "mlr" in experiment.signals


EFFECT = Effect(
    title="balance drift",
    family="apparatus",
    group="balance",
    equation="mlr = mlr_0 + b",
    strength={
        "offset_kg_m2s": Quantity(
            symbol="b",
            label="offset of the mass loss rate",
            unit="kg/(m2 s)",
            lower=-1e-3,
            upper=1e-3,
            value=0.0,
            typical=1e-4,
        )
    },
    experiment=on("signals.mlr", {"offset": "offset_kg_m2s"}),
    needs=_has_mlr,
)
