"""From an experiment in words to the arrays of the kernels, for all sets at once as in `lower`."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from pyrofit.model import material as words
from pyrofit.model.base import numbers, value_of
from pyrofit.model.slab import Edge, EmissivityDepth, Foil, Sample, Side, SlabExperiment
from pyrofit.solver.arrays import (
    TABLE_TEMPERATURES_K,
    Exposure,
    FloatArray,
    IntArray,
    Material,
    Number,
    Surface,
    Value,
    Values,
)
from pyrofit.solver.curves import Place, Request
from pyrofit.solver.lower import fractions, total
from pyrofit.solver.schedule import lower_schedule


class Layer(NamedTuple):
    """A layer of the virgin sample, or behind it."""

    mass: FloatArray
    """Mass per area of its components [kg/m2], shape (components, sets)."""
    thickness: Number
    """[m], shape (sets,)."""
    cells: Number | None = None
    """How many it has, shape (sets,); none = its share of the sample's."""
    added: bool = False
    """Whether its share of the sample's cells comes on top of these; it may be none."""


def number(value: Value, sets: int) -> Number:
    """Return a value for every set, shape (sets,)."""
    if sets == 1 and isinstance(value, float):
        return np.array([value])
    return np.full(sets, value, np.float64)


def _surface(side: Side, values: Values, sets: int, factor: Value = 1.0) -> Surface:
    return Surface(
        h_cube_root=number(factor * value_of(side.h_cube_root_W_m2K43, values), sets),
        gas_rise=number(value_of(side.gas_rise_K, values), sets),
        gas_rise_time=number(value_of(side.gas_rise_time_s, values), sets),
    )


def lower_exposure(
    experiment: SlabExperiment, share: FloatArray, arrays: Material, values: Values, sets: int = 1
) -> Exposure:
    """Return what acts on the sample, whose front layer has these mass fractions, as arrays.

    What no parameter changes is made once for a set that runs alone.
    """
    depth = _mixing_depth(experiment, share, arrays, values)
    fixed = experiment.derived("exposure", _fixed_exposure) if sets == 1 else None
    found = fixed or _exposure(experiment, values, sets)
    return found._replace(mixing_depth=number(depth, sets))


def _fixed_exposure(experiment: SlabExperiment) -> Exposure | None:
    """Return the exposure of one set, none if a parameter changes it."""
    sample = experiment.sample
    parts = experiment.front, experiment.back, sample.foil, sample.edge, experiment.burning()
    named = any(isinstance(leaf, str) for part in parts for _, leaf, _ in numbers(part))
    numbers_of = sample.emissivity_change, sample.surface_share, sample.gas_specific_heat_J_kgK
    if named or any(isinstance(number, str) for number in numbers_of):
        return None
    return _exposure(experiment, {}, 1)


def _exposure(experiment: SlabExperiment, values: Values, sets: int) -> Exposure:
    """Return the exposure without its mixing depth."""
    front, back, sample = experiment.front, experiment.back, experiment.sample
    losses = value_of(back.loss_factor, values)
    capacity, contact = _foil(sample.foil, values)
    exchange, edge_gas = _edge(sample.edge, values)
    return Exposure(
        front=_surface(front, values, sets),
        back=_surface(back, values, sets, losses),
        schedule=lower_schedule(experiment, values, sets),
        rise_time=number(value_of(front.rise_time_s, values), sets),
        drift=number(value_of(front.drift_1_s, values), sets),
        drift_time=number(value_of(front.drift_time_s, values), sets),
        back_emissivity=number(losses * value_of(back.emissivity, values), sets),
        foil_capacity=number(capacity, sets),
        contact_resistance=number(contact, sets),
        back_absorbs=sample.back_absorbs,
        surface_share=number(value_of(sample.surface_share, values), sets),
        gas_heat=number(value_of(sample.gas_specific_heat_J_kgK, values), sets),
        mixing_depth=number(0.0, sets),
        emissivity_change=number(value_of(sample.emissivity_change, values), sets),
        backing_mass=number(0.0, sets),
        backing_thickness=number(0.0, sets),
        backing_cells=number(0.0, sets),
        edge_exchange=number(exchange, sets),
        edge_temperature=number(edge_gas, sets),
    )


def _foil(foil: Foil | None, values: Values) -> tuple[Value, Value]:
    """Return heat capacity [J/(m2 K)] and resistance to the sample [m2 K/W]."""
    if foil is None:
        return 0.0, 0.0
    mass = value_of(foil.thickness_m, values) * value_of(foil.density_kg_m3, values)
    mass = mass * value_of(foil.mass_factor, values)
    capacity = mass * value_of(foil.specific_heat_J_kgK, values)
    return capacity, value_of(foil.contact_m2K_W, values)


def _edge(edge: Edge | None, values: Values) -> tuple[Value, Value]:
    """Return h times perimeter over area [W/(m3 K)] and the gas temperature [K]."""
    if edge is None:
        return 0.0, 0.0
    exchange = value_of(edge.h_W_m2K, values) * value_of(edge.perimeter_per_area_1_m, values)
    return exchange, value_of(edge.gas_temperature_K, values)


def _mixing_depth(
    experiment: SlabExperiment, share: FloatArray, arrays: Material, values: Values
) -> Value:
    depth = experiment.sample.emissivity_depth
    if not isinstance(depth, EmissivityDepth):
        return value_of(depth, values)
    volume = share * arrays.specific_volume
    T = value_of(experiment.sample.initial_temperature_K, values)
    k = total(volume * at_temperature(arrays.conductivity, T)) / total(volume)
    rho_c = total(share * at_temperature(arrays.specific_heat, T)) / total(volume)
    return value_of(depth.cell_size_factor, values) * np.sqrt(k / rho_c)


def at_temperature(tables: FloatArray, T: Value) -> FloatArray:
    """Return the properties of all components at T, shape (components, sets)."""
    if tables.shape[1] == 1:
        return tables[:, 0]
    at = np.broadcast_to(T, tables.shape[2:])
    return np.array(
        [
            [np.interp(x, TABLE_TEMPERATURES_K, table[:, s]) for s, x in enumerate(at)]
            for table in tables
        ]
    )


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
    composition = experiment.sample.layers[0].composition or material.composition
    return fractions(composition, list(material.components), values, sets)


def lower_layers(
    experiment: SlabExperiment,
    material: words.Material,
    arrays: Material,
    values: Values,
    sets: int = 1,
) -> tuple[Layer, ...]:
    """Return the layers of the virgin sample, front first, and the adhesive behind them."""
    names = list(material.components)
    sample = experiment.sample
    layers = []
    for layer, size in zip(sample.layers, thicknesses(sample, values), strict=True):
        share = fractions(layer.composition or material.composition, names, values, sets)
        mass = size / total(share * arrays.specific_volume)
        layers.append(Layer(share * mass, number(size, sets)))
    if sample.adhesive is not None:
        i, size = (
            names.index(sample.adhesive.component),
            value_of(sample.adhesive.thickness_m, values),
        )
        mass = np.zeros((len(names), sets))
        mass[i] = size / arrays.specific_volume[i]
        layers.append(Layer(mass, number(size, sets), added=True))
    return tuple(layers)


def cells_of(
    layers: tuple[Layer, ...], cells: IntArray, multiple: int = 1
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


def _added(layer: Layer, sample: list[Layer], cells: IntArray) -> IntArray:
    """Return the cells of an added layer, at least two; none where it has no thickness."""
    share = np.rint(cells * layer.thickness / sum(of.thickness for of in sample))
    return np.where(layer.thickness > 0.0, np.maximum(2, share), 0).astype(np.int64)
