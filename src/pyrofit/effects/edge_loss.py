"""The edge of the sample exchanges heat with the gas beside it."""

from pyrofit.effects.base import Effect, Numbers, Quantity, changed
from pyrofit.model.experiment import Experiment
from pyrofit.model.slab import Edge, SlabExperiment


def _change(experiment: Experiment, at: Numbers) -> Experiment:
    assert isinstance(experiment, SlabExperiment)
    if experiment.sample.edge is not None:
        raise ValueError("the sample has an edge already")
    edge = Edge(
        h_W_m2K=at["h_W_m2K"],
        perimeter_per_area_1_m=at["perimeter_per_area_1_m"],
        # ASSUME: the gas beside the sample is the one behind it, not the heated one before it.
        gas_temperature_K=experiment.back.gas_temperature_K,
    )
    return changed(experiment, sample=changed(experiment.sample, edge=edge))


EFFECT = Effect(
    title="edge loss",
    family="environment",
    group="edge loss",
    equation="q''' = -h (P/A) (T - T_gas), T_gas of the back",
    strength={
        "h_W_m2K": Quantity(
            symbol="h",
            label="heat transfer coefficient of the edge",
            unit="W/(m2 K)",
            lower=0.0,
            upper=60.0,
            value=0.0,
            typical=10.0,
            plausible=(0.0, 15.0),
        )
    },
    form={
        "perimeter_per_area_1_m": Quantity(
            symbol="P/A",
            label="perimeter over area of the sample",
            unit="1/m",
            lower=10.0,
            upper=200.0,
            value=57.0,
            typical=40.0,
            source="a disc of 70 mm has 57 1/m, a square of 100 mm 40 1/m",
        )
    },
    experiment=_change,
)
