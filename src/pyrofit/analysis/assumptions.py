"""Numbers of the surroundings that a study takes as given, though they are seldom measured."""

from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.model.slab import SlabExperiment


def assumptions(study: Study) -> dict[str, list[str]]:
    """Return flame flux, h and backing of the fitted slabs, in words, with the tests they hold for.

    A number that is estimated or named as a parameter is no assumption here.
    """
    fitted = {channel.experiment for channel in study.imp.channels}
    found: dict[str, list[str]] = {}
    for name, experiment in study.experiments.items():
        if name in fitted and isinstance(experiment, SlabExperiment):
            test = experiment.repeat.test if experiment.repeat else name
            for words in _of(experiment):
                tests = found.setdefault(words, [])
                if test not in tests:
                    tests.append(test)
    return found


def _of(slab: SlabExperiment) -> Iterator[str]:
    flame = slab.burning()
    if flame is not None and isinstance(flame.flux_W_m2, float):
        yield f"heat flux of the flame {1e-3 * flame.flux_W_m2:g} kW/m²"
    if isinstance(slab.front.h_W_m2K, float):
        yield f"h of the front {slab.front.h_W_m2K:g} W/(m² K)"
    if slab.sample.backing:
        return
    if isinstance(slab.back.h_W_m2K, float) and isinstance(slab.back.emissivity, float):
        if slab.back.h_W_m2K == 0.0 and slab.back.emissivity == 0.0:
            yield "an insulated back"
        else:
            yield f"h of the back {slab.back.h_W_m2K:g} W/(m² K)"
