"""From an experiment in words to the arrays of the kernels."""

import math

import numpy as np

from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.experiment import (
    Edge,
    EmissivityDepth,
    FluxTable,
    Foil,
    Gasification,
    Sample,
    Side,
)
from pyrofit.solver.arrays import TABLE_TEMPERATURES_K, Exposure, FloatArray, Material, Surface
from pyrofit.solver.grid import Virgin
from pyrofit.solver.lower import Values, fractions


def _surface(side: Side, values: Values, factor: float = 1.0) -> Surface:
    return Surface(
        h=factor * max(value_of(side.h_W_m2K, values) + value_of(side.h_change_W_m2K, values), 0.0),
        h_cube_root=factor * value_of(side.h_cube_root_W_m2K43, values),
        gas_temperature=value_of(side.gas_temperature_K, values),
        gas_rise=value_of(side.gas_rise_K, values),
        gas_rise_time=value_of(side.gas_rise_time_s, values),
        wall_temperature=value_of(side.wall_temperature_K, values),
    )


def lower_exposure(
    experiment: Gasification, material: words.Material, arrays: Material, values: Values
) -> Exposure:
    """Return what acts on the sample as arrays."""
    front, back, sample = experiment.front, experiment.back, experiment.sample
    times, fluxes = _flux(front.flux_W_m2, values)
    losses = value_of(back.loss_factor, values)
    capacity, contact = _foil(sample.foil, values)
    exchange, edge_gas = _edge(sample.edge, values)
    return Exposure(
        front=_surface(front, values),
        back=_surface(back, values, losses),
        flux_time=times,
        flux=fluxes,
        rise_time=value_of(front.rise_time_s, values),
        drift=value_of(front.drift_1_s, values),
        drift_time=value_of(front.drift_time_s, values),
        back_emissivity=losses * value_of(back.emissivity, values),
        foil_capacity=capacity,
        contact_resistance=contact,
        foil_opaque=sample.foil is not None and sample.transmitted == "foil",
        mixing_depth=_mixing_depth(experiment, material, arrays, values),
        emissivity_change=value_of(sample.emissivity_change, values),
        edge_exchange=exchange,
        edge_temperature=edge_gas,
    )


def _flux(flux: float | str | FluxTable, values: Values) -> tuple[FloatArray, FloatArray]:
    """Return times [s] and fluxes [W/m2]."""
    if isinstance(flux, FluxTable):
        return np.array(flux.time_s), np.array([value_of(q, values) for q in flux.flux_W_m2])
    return np.zeros(1), np.array([value_of(flux, values)])


def _foil(foil: Foil | None, values: Values) -> tuple[float, float]:
    """Return heat capacity [J/(m2 K)] and resistance to the sample [m2 K/W]."""
    if foil is None:
        return 0.0, 0.0
    mass = value_of(foil.thickness_m, values) * value_of(foil.density_kg_m3, values)
    mass *= value_of(foil.mass_factor, values)
    capacity = mass * value_of(foil.specific_heat_J_kgK, values)
    return capacity, value_of(foil.contact_m2K_W, values)


def _edge(edge: Edge | None, values: Values) -> tuple[float, float]:
    """Return h times perimeter over area [W/(m3 K)] and the gas temperature [K]."""
    if edge is None:
        return 0.0, 0.0
    exchange = value_of(edge.h_W_m2K, values) * value_of(edge.perimeter_per_area_1_m, values)
    return exchange, value_of(edge.gas_temperature_K, values)


def _mixing_depth(
    experiment: Gasification, material: words.Material, arrays: Material, values: Values
) -> float:
    depth = experiment.sample.emissivity_depth
    if not isinstance(depth, EmissivityDepth):
        return value_of(depth, values)
    names = list(material.components)
    composition = experiment.sample.layers[0].composition or material.composition
    share = fractions(composition, names, values)
    volume = share * arrays.specific_volume
    k = float(volume @ _at(arrays.conductivity, experiment, values)) / volume.sum()
    rho_c = float(share @ _at(arrays.specific_heat, experiment, values)) / volume.sum()
    return value_of(depth.cell_size_factor, values) * math.sqrt(k / rho_c)


def _at(table: FloatArray, experiment: Gasification, values: Values) -> FloatArray:
    if table.shape[1] == 1:
        return table[:, 0]
    T = value_of(experiment.sample.initial_temperature_K, values)
    return np.array([np.interp(T, TABLE_TEMPERATURES_K, row) for row in table])


def thicknesses(sample: Sample, values: Values) -> list[float]:
    """Return the thickness of each layer [m]."""
    factor = value_of(sample.thickness_factor, values)
    return [factor * value_of(layer.thickness_m, values) for layer in sample.layers]


def lower_virgin(experiment: Gasification, material: words.Material, values: Values) -> Virgin:
    """Return what the sample is before it reacts."""
    layers = experiment.sample.layers
    composition = layers[0].composition or material.composition
    return Virgin(
        share=fractions(composition, list(material.components), values),
        thickness=sum(thicknesses(experiment.sample, values)),
        temperature=value_of(experiment.sample.initial_temperature_K, values),
    )


def lower_cells(
    experiment: Gasification,
    material: words.Material,
    arrays: Material,
    values: Values,
    cells: int,
) -> FloatArray:
    """Return the initial masses [kg/m2], shape (cells, components), front first.

    The cells are shared out by thickness, at least two to a layer, equally thick in a layer.
    """
    names = list(material.components)
    layers = experiment.sample.layers
    thickness = thicknesses(experiment.sample, values)
    parts = []
    for layer, size in zip(layers, thickness, strict=True):
        count = cells if len(layers) == 1 else max(2, round(cells * size / sum(thickness)))
        share = fractions(layer.composition or material.composition, names, values)
        mass = size / float(share @ arrays.specific_volume)
        parts.append(np.full((count, len(names)), share * mass / count))
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
