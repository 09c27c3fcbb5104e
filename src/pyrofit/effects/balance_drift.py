"""The balance drifts, so that the mass loss rate is wrong by a constant."""

from pyrofit.effects.base import Effect, Numbers, Quantity, need, on
from pyrofit.model.experiment import Experiment


def _rates(experiment: Experiment) -> list[str]:
    """Return the signals that are mass loss rates."""
    of = experiment.quantity
    return [s for s in experiment.signals if of(s).released and of(s).sampling == "bin mean"]


@need("a mass loss rate")
def _has_rate(experiment: Experiment) -> bool:
    return bool(_rates(experiment))


def _change(experiment: Experiment, at: Numbers) -> Experiment:
    for name in _rates(experiment):
        experiment = on(f"signals.{name}", {"offset": "offset_kg_m2s"})(experiment, at)
    return experiment


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
            plausible=(-0.0003, 0.0003),
        )
    },
    experiment=_change,
    needs=_has_rate,
)
