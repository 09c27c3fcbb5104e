"""How a slab under radiant heat is simulated."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from pyrofit.experiments.base import Asked
from pyrofit.model.accuracy import Resolution
from pyrofit.model.material import Material
from pyrofit.model.signal import Signal
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Curves, Place, Request


def reference(
    experiment: SlabExperiment,
    material: Material,
    values: Mapping[str, float],
    asked: Asked,
    resolution: Resolution,
) -> Curves:
    """Return the curves of the reference solver."""
    # Not above: loading its integrator takes a quarter of the time of a small job.
    from pyrofit.solver.reference.gasification import reference_gasification

    return reference_gasification(experiment, material, values, asked, resolution)


def request(
    experiment: SlabExperiment, signal: str, frame: pd.DataFrame, times: FloatArray
) -> Request:
    """Return the request to a simulation at the given times of a signal."""
    return request_at(experiment, signal, times)


def request_at(experiment: SlabExperiment, signal: str, times: FloatArray) -> Request:
    """Return the request to a simulation at the given times of a signal."""
    described, quantity = experiment.signals[signal], experiment.quantity(signal)
    return Request(
        times,
        described.average_s,
        output=quantity.curve,
        place=None if quantity.place == "fixed" else _place(described),
    )


def _place(signal: Signal) -> Place:
    """Return where in the sample a temperature is measured."""
    depth = 0.0 if signal.depth_m is None else signal.depth_m
    return Place(depth, signal.layer, signal.follows or "material")


def synthetic(experiment: SlabExperiment, signals: Sequence[str]) -> dict[str, Request]:
    """Return the requests of computed signals: points in the middle of equal bins."""
    requests = {}
    for name in signals:
        every = experiment.signals[name].every
        times = np.arange(0.5 * every, experiment.duration_s, every)
        requests[name] = request_at(experiment, name, times)
    return requests
