"""All records of an experiment are late."""

from pyrofit.effects.base import Effect, Numbers, Quantity, on
from pyrofit.model.experiment import Experiment


def _change(experiment: Experiment, at: Numbers) -> Experiment:
    for name in experiment.signals:
        experiment = on(f"signals.{name}", {"delay_s": "delay_s"})(experiment, at)
    return experiment


EFFECT = Effect(
    title="time offset",
    family="apparatus",
    group="timing",
    equation="y(t) = y_0(t - t_0)",
    strength={
        "delay_s": Quantity(
            symbol="t_0",
            label="delay of the records",
            unit="s",
            lower=-25.0,
            upper=25.0,
            value=0.0,
            typical=5.0,
            plausible=(-8.0, 8.0),
            source="assumed range; bins of 5 s alone make 2.5 s",
        )
    },
    experiment=_change,
    same_as="heater_ramp",
)
