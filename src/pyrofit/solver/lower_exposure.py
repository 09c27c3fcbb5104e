"""From the surroundings of a slab in words to the arrays of the kernels."""

import numpy as np

from pyrofit.model.base import numbers, value_of
from pyrofit.model.slab import Edge, EmissivityDepth, Foil, SlabExperiment
from pyrofit.model.slab_faces import Side
from pyrofit.solver.arrays import (
    TABLE_TEMPERATURES_K,
    Exposure,
    FloatArray,
    Material,
    Number,
    Surface,
    Value,
    Values,
)
from pyrofit.solver.lower_property import total
from pyrofit.solver.schedule import lower_schedule


def number_of_sets(value: Value, sets: int) -> Number:
    """Return a value for every set, shape (sets,)."""
    if sets == 1 and isinstance(value, float):
        return np.array([value])
    return np.full(sets, value, np.float64)


def _surface(side: Side, values: Values, sets: int, factor: Value = 1.0) -> Surface:
    return Surface(
        h_cube_root=number_of_sets(factor * value_of(side.h_cube_root_W_m2K43, values), sets),
        gas_rise=number_of_sets(value_of(side.gas_rise_K, values), sets),
        gas_rise_time=number_of_sets(value_of(side.gas_rise_time_s, values), sets),
    )


def lower_exposure(
    experiment: SlabExperiment,
    share: FloatArray,
    arrays: Material,
    values: Values,
    sets: int = 1,
) -> Exposure:
    """Return the exposure of a sample, whose front layer has these mass fractions, as arrays.

    An exposure that no parameter changes is made once for a set that runs alone.
    """
    depth = _mixing_depth(experiment, share, arrays, values)
    fixed = experiment.derived("exposure", _fixed_exposure) if sets == 1 else None
    found = fixed or _exposure(experiment, values, sets)
    return found._replace(mixing_depth=number_of_sets(depth, sets))


def _fixed_exposure(experiment: SlabExperiment) -> Exposure | None:
    """Return the exposure of one set, none if a parameter changes it."""
    sample = experiment.sample
    parts = experiment.front, experiment.back, sample.foil, sample.edge, experiment.burning()
    named = any(isinstance(leaf, str) for part in parts for _, leaf, _ in numbers(part))
    numbers_of = (
        experiment.oxygen,
        sample.emissivity_change,
        sample.surface_share,
        sample.gas_specific_heat_J_kgK,
    )
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
        rise_time=number_of_sets(value_of(front.rise_time_s, values), sets),
        drift=number_of_sets(value_of(front.drift_1_s, values), sets),
        drift_time=number_of_sets(value_of(front.drift_time_s, values), sets),
        back_emissivity=number_of_sets(losses * value_of(back.emissivity, values), sets),
        foil_capacity=number_of_sets(capacity, sets),
        contact_resistance=number_of_sets(contact, sets),
        back_absorbs=sample.back_absorbs,
        surface_share=number_of_sets(value_of(sample.surface_share, values), sets),
        gas_heat=number_of_sets(value_of(sample.gas_specific_heat_J_kgK, values), sets),
        mixing_depth=number_of_sets(0.0, sets),
        emissivity_change=number_of_sets(value_of(sample.emissivity_change, values), sets),
        backing_mass=number_of_sets(0.0, sets),
        backing_thickness=number_of_sets(0.0, sets),
        backing_cells=number_of_sets(0.0, sets),
        edge_exchange=number_of_sets(exchange, sets),
        edge_temperature=number_of_sets(edge_gas, sets),
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
    size = total(volume)
    k = total(volume * properties_at(arrays.conductivity, T)) / size
    rho_c = total(share * properties_at(arrays.specific_heat, T)) / size
    return value_of(depth.cell_size_factor, values) * np.sqrt(k / rho_c)


def properties_at(tables: FloatArray, T: Value) -> FloatArray:
    """Return the properties of all components at T, shape (components, sets)."""
    if tables.shape[1] == 1:
        return tables[:, 0]
    nodes, sets = TABLE_TEMPERATURES_K, np.arange(tables.shape[2])
    at = np.clip(np.broadcast_to(T, sets.shape), nodes[0], nodes[-1])
    k = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, nodes.size - 2)
    low, high = tables[:, k, sets], tables[:, k + 1, sets]
    return np.asarray((high - low) / (nodes[k + 1] - nodes[k]) * (at - nodes[k]) + low)
