"""Temperatures inside the slab, from the states of a run."""

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.slab import Sample
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.curves import Place
from pyrofit.solver.reference.slab import Slab
from pyrofit.solver.reference.substance import Values


def inside(
    slab: Slab, states: FloatArray, place: Place, sample: Sample, values: Values
) -> FloatArray:
    """Return T at a place in the sample, linear between nodes, shape (states,)."""
    T, extent = slab.split(states)
    # The contact to a foil, which has no mass, is not of the sample.
    own = slab.mass > 0.0
    T, count = T[:, : own.sum() + 1], own.sum()
    virgin = slab.mass[own] * (slab.virgin[own] / slab.substance.density).sum(axis=-1)
    depth = np.concatenate(([0.0], np.cumsum(virgin)))
    at = _depth(place, sample, values)
    if place.follows == "material":
        return np.array([np.interp(at, depth, row) for row in T])
    now = slab.thickness(slab.split(states)[0], extent)[:, :count]
    heights = np.cumsum(now[:, ::-1], axis=1)
    heights = np.concatenate((np.zeros((len(now), 1)), heights), axis=1)
    rows = zip(heights, T[:, ::-1], strict=True)
    return np.array([np.interp(depth[-1] - at, height, row) for height, row in rows])


def _depth(place: Place, sample: Sample, values: Values) -> float:
    """Return the depth of a place in the virgin sample [m]."""
    if place.layer is None:
        assert not isinstance(place.depth_m, np.ndarray)
        return value_of(place.depth_m, values)
    factor = value_of(sample.thickness_factor, values)
    layers = sample.layers[: place.layer]
    return factor * sum(value_of(layer.thickness_m, values) for layer in layers)
