"""Experiments of which quantities are predicted that nobody measured."""

from pyrofit.config.keys.study import Study
from pyrofit.model.slab import SlabExperiment


def unmeasured(study: Study) -> dict[str, tuple[str, ...]]:
    """Return the quantities that are predicted without a measurement, by experiment."""
    return {
        name: experiment.predicts
        for name, experiment in study.experiments.items()
        if isinstance(experiment, SlabExperiment) and experiment.predicts
    }
