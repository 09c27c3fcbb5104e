"""From an experiment in words to the arrays of the kernels, for all sets at once as in `lower`."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.slab import Sample, SlabExperiment
from pyrofit.solver.arrays import (
    FloatArray,
    IntArray,
    Material,
    Number,
    Value,
    Values,
)
from pyrofit.solver.curves import Place, Request
from pyrofit.solver.lower import fractions
from pyrofit.solver.lower_exposure import number_of_sets
from pyrofit.solver.lower_property import total


class LoweredLayer(NamedTuple):
    """A layer of the virgin sample, or behind it."""

    mass: FloatArray
    """Mass per area of its components [kg/m2], shape (components, sets)."""
    thickness: Number
    """[m], shape (sets,)."""
    cells: Number | None = None
    """How many it has, shape (sets,); none = its share of the sample's."""
    added: bool = False
    """Whether its share of the sample's cells comes on top of these; it may be none."""


def thicknesses(sample: Sample, values: Values) -> list[Value]:
    """Return the thickness of each layer [m]."""
    factor = value_of(sample.thickness_factor, values)
    return [factor * value_of(layer.thickness_m, values) for layer in sample.layers]


def lower_places(
    sample: Sample, requests: Mapping[str, Request], values: Values, sets: int = 1
) -> dict[str, Request]:
    """Return the requests with the depths of their places as numbers [m], shape (sets,)."""
    return {
        name: r if r.place is None else replace(r, place=_located(r.place, sample, values, sets))
        for name, r in requests.items()
    }


def _located(place: Place, sample: Sample, values: Values, sets: int) -> Place:
    depth: Value
    if place.layer is not None:
        depth = sum(thicknesses(sample, values)[: place.layer])
    elif isinstance(place.depth_m, str):
        depth = values[place.depth_m]
    else:
        depth = place.depth_m
    return replace(place, depth_m=np.full(sets, depth, np.float64))


def lower_share(
    experiment: SlabExperiment, material: words.Material, values: Values, sets: int = 1
) -> FloatArray:
    """Return the mass fractions of the front layer, shape (components, sets)."""
    composition = experiment.sample.layers[0].composed(material.composition)
    return fractions(composition, list(material.components), values, sets)


def lower_layers(
    experiment: SlabExperiment,
    material: words.Material,
    arrays: Material,
    values: Values,
    sets: int = 1,
    front: FloatArray | None = None,
) -> tuple[LoweredLayer, ...]:
    """Return the layers of the virgin sample, front first, and the adhesive behind them.

    ``front`` are the mass fractions of the front layer, if they are known.
    """
    names = list(material.components)
    sample = experiment.sample
    layers = []
    for layer, size in zip(sample.layers, thicknesses(sample, values), strict=True):
        share = front
        if share is None or layer is not sample.layers[0]:
            share = fractions(layer.composed(material.composition), names, values, sets)
        mass = size / total(share * arrays.specific_volume)
        layers.append(LoweredLayer(share * mass, number_of_sets(size, sets)))
    if sample.adhesive is not None:
        i, size = (
            names.index(sample.adhesive.component),
            value_of(sample.adhesive.thickness_m, values),
        )
        mass = np.zeros((len(names), sets))
        mass[i] = size / arrays.specific_volume[i]
        layers.append(LoweredLayer(mass, number_of_sets(size, sets), added=True))
    return tuple(layers)


def share_out_cells(
    layers: tuple[LoweredLayer, ...], cells: IntArray, multiple: int = 1
) -> tuple[FloatArray, IntArray]:
    """Share out the cells by thickness, at least two to a layer, equally thick in a layer.

    Layers that have a number of cells of their own keep it. The number of all cells is made a
    multiple by empty ones ahead of the others.

    Returns
    -------
    masses [kg/m2], shape (cells, components, sets), front first, and how many of these cells are
    empty, shape (sets,).
    """
    sample = [layer for layer in layers if layer.cells is None and not layer.added]
    if len(sample) == 1:
        counts = [cells]
    else:
        size = sum(layer.thickness for layer in sample)
        shares = [np.rint(cells * layer.thickness / size) for layer in sample]
        counts = [np.maximum(2, share).astype(np.int64) for share in shares]
    if len(layers) == 1 and cells.size == 1:
        return _equal_cells(layers[0], int(cells[0]), multiple)
    counts += [_added(layer, sample, cells) for layer in layers if layer.added]
    counts += [layer.cells.astype(np.int64) for layer in layers if layer.cells is not None]
    needed = np.asarray(sum(counts))
    most = -(-int(needed.max()) // multiple) * multiple
    empty = most - needed
    out = np.zeros((most, *layers[0].mass.shape))
    begin = empty
    n = np.arange(most)[:, None]
    for layer, count in zip(layers, counts, strict=True):
        here = (n >= begin) & (n < begin + count)
        out += np.where(here[:, None, :], layer.mass / np.maximum(count, 1), 0.0)
        begin = begin + count
    return out, empty


def _equal_cells(layer: LoweredLayer, count: int, multiple: int) -> tuple[FloatArray, IntArray]:
    """Return the masses of the cells, and the empty ones, for one set of one layer."""
    empty = -count % multiple
    out = np.zeros((empty + count, *layer.mass.shape))
    out[empty:] = layer.mass / count
    return out, np.array([empty])


def _added(layer: LoweredLayer, sample: list[LoweredLayer], cells: IntArray) -> IntArray:
    """Return the cells of an added layer, at least two; none where it has no thickness."""
    share = np.rint(cells * layer.thickness / sum(of.thickness for of in sample))
    return np.where(layer.thickness > 0.0, np.maximum(2, share), 0).astype(np.int64)
