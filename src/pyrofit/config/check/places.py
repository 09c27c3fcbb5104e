"""Whether the places at which temperatures are measured lie in the sample."""

from pyrofit.config.check.expressions import ends_of
from pyrofit.config.keys.study import Study
from pyrofit.config.words import require
from pyrofit.model.slab import SlabExperiment


def check_places(study: Study) -> None:
    """Refuse a depth outside the sample, and a layer that it has not.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    for name, experiment in study.experiments.items():
        if not isinstance(experiment, SlabExperiment):
            continue
        for label, signal in experiment.signals.items():
            place = f"experiments.{name}.signals.{label}"
            if signal.depth_m is not None:
                _check_depth(study, experiment, signal.depth_m, f"{place}.depth_m")
            count = len(experiment.sample.layers)
            require(
                signal.layer is None or signal.layer <= count,
                f"{place}.layer",
                f"there is no layer {signal.layer}; the sample has {count}, and behind layer "
                f"{count} lies its back face",
            )


def _check_depth(study: Study, experiment: SlabExperiment, depth: float | str, place: str) -> None:
    """Refuse a depth that may exceed that of sample and backing, within the limits of all."""
    sample = experiment.sample
    thinnest = min(ends_of(study, sample.thickness_factor)) * sum(
        min(ends_of(study, layer.thickness_m)) for layer in sample.layers
    )
    thinnest += sum(min(ends_of(study, layer.thickness_m)) for layer in sample.backing)
    deepest = max(ends_of(study, depth))
    require(
        deepest <= thinnest * (1.0 + 1e-9),
        place,
        f"{deepest:g} m lies outside the sample, whose layers are {thinnest:g} m thick together; "
        "depths count from the initial front. Give one within the sample",
    )
