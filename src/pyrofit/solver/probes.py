"""Temperatures inside a slab: from the places of requests to those of the kernel."""

from collections.abc import Mapping

import numpy as np

from pyrofit.solver.arrays import FloatArray, IntArray, Probes
from pyrofit.solver.curves import Request
from pyrofit.solver.lower_property import total


def follows_of(request: Request) -> str:
    """Return `follows` of a request's place, empty without a place."""
    return "" if request.place is None else request.place.follows


def depths_of(asked: Mapping[str, Request], follows: str, sets: int) -> FloatArray:
    """Return the depths [m] of the probes that follow one thing, shape (sets, probes)."""
    places = [r.place for r in asked.values() if r.place is not None]
    if not places:
        return np.empty((sets, 0))
    found = [place.depth_m for place in places if place.follows == follows]
    return np.reshape(np.array(found, np.float64), (-1, sets)).T


def probes_of(
    depths: Probes,
    start: FloatArray,
    empty: IntArray,
    volumes: FloatArray,
) -> Probes:
    """Return the probes of sets as the kernel takes them; outside the sample lies none."""
    if not (depths.material.size or depths.fixture.size):
        return depths
    probes = Probes(*(np.array(depth, order="C") for depth in depths))
    thickness = total((start * volumes).swapaxes(0, 1))
    for lane, ahead in enumerate(empty):
        edges = np.concatenate(([0.0], np.cumsum(thickness[ahead:, lane])))
        cells = np.arange(edges.size)
        probes.material[lane] = np.interp(probes.material[lane], edges, cells)
        probes.fixture[lane] = np.clip(edges[-1] - probes.fixture[lane], 0.0, edges[-1])
    return probes
