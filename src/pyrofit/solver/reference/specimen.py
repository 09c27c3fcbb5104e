"""The specimen of an experiment as the reference solver takes it."""

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit.model.slab import EmissivityDepth, Sample, SlabExperiment
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.reference.slab import Slab
from pyrofit.solver.reference.substance import NumericSubstance, Values, mass_fractions, substance
from pyrofit.solver.reference.surroundings import rim, surface


def make_slab(
    experiment: SlabExperiment, material: Material, values: Values, elements: int
) -> Slab:
    """Return the slab of an experiment; a layer has elements of one thickness, at least two."""
    sample, back = experiment.sample, experiment.back
    factors = sample.absorption_length_m, sample.density_factor, sample.conductivity_factor
    solid = substance(material, values, *(value_of(x, values) for x in factors))
    virgin, mass = _elements(sample, material, solid, values, elements)
    count = mass.size
    virgin, mass = _with_backing(virgin, mass, sample, solid, values, max(2, elements // 4))
    T_start = value_of(sample.initial_temperature_K, values)
    losses = value_of(back.loss_factor, values)
    capacity, contact = _foil(sample, values)
    depth = _mixing_depth(sample.emissivity_depth, solid, virgin[0], T_start, values)
    if contact > 0.0:
        virgin = np.concatenate((virgin, np.zeros((1, virgin.shape[1]))))
        mass = np.append(mass, 0.0)
    return Slab(
        substance=solid,
        virgin=virgin,
        mass=mass,
        sample=count,
        T_start=T_start,
        front=surface(experiment.front, values),
        back=surface(back, values, losses),
        back_emissivity=losses * value_of(back.emissivity, values),
        foil_capacity=capacity,
        contact_resistance=contact,
        back_absorbs=sample.back_absorbs,
        mixing_depth=depth,
        emissivity_change=value_of(sample.emissivity_change, values),
        surface_share=value_of(sample.surface_share, values),
        gas_heat=value_of(sample.gas_specific_heat_J_kgK, values),
        rim=rim(sample.edge, values),
    )


def _elements(
    sample: Sample, material: Material, solid: NumericSubstance, values: Values, elements: int
) -> tuple[FloatArray, FloatArray]:
    """Return the mass fractions and masses [kg/m2] of the elements before they react."""
    factor = value_of(sample.thickness_factor, values)
    sizes = [factor * value_of(layer.thickness_m, values) for layer in sample.layers]
    virgin, mass = [], []
    for layer, size in zip(sample.layers, sizes, strict=True):
        count = max(2, round(elements * size / sum(sizes)))
        share = mass_fractions(layer.composed(material.composition), solid.names, values)
        virgin.append(np.tile(share, (count, 1)))
        mass.append(np.full(count, size / count / (share / solid.density).sum()))
    glue = sample.adhesive
    size = value_of(glue.thickness_m, values) if glue else 0.0
    if glue and size > 0.0:
        count = max(2, round(elements * size / sum(sizes)))
        share = np.array([float(name == glue.component) for name in solid.names])
        virgin.append(np.tile(share, (count, 1)))
        mass.append(np.full(count, size / count * linear.dot(share, solid.density)))
    return np.concatenate(virgin), np.concatenate(mass)


def _with_backing(
    virgin: FloatArray,
    mass: FloatArray,
    sample: Sample,
    solid: NumericSubstance,
    values: Values,
    count: int,
) -> tuple[FloatArray, FloatArray]:
    """Return them with those of the inert layers behind the sample, ``count`` to a layer."""
    for layer in sample.backing:
        share = np.array([float(name == layer.component) for name in solid.names])
        of_layer = value_of(layer.thickness_m, values) * linear.dot(share, solid.density)
        virgin = np.concatenate((virgin, np.tile(share, (count, 1))))
        mass = np.concatenate((mass, np.full(count, of_layer / count)))
    return virgin, mass


def _foil(sample: Sample, values: Values) -> tuple[float, float]:
    """Return the foil's heat capacity [J/(m2 K)] and its resistance to the sample [m2 K/W]."""
    foil = sample.foil
    if foil is None:
        return 0.0, 0.0
    mass = value_of(foil.thickness_m, values) * value_of(foil.density_kg_m3, values)
    mass *= value_of(foil.mass_factor, values)
    capacity = mass * value_of(foil.specific_heat_J_kgK, values)
    return capacity, value_of(foil.contact_m2K_W, values)


def _mixing_depth(
    given: float | str | EmissivityDepth,
    solid: NumericSubstance,
    share: FloatArray,
    T: float,
    values: Values,
) -> float:
    """Return the depth of the surface emissivity [m], for FDS's of the first layer's material."""
    if not isinstance(given, EmissivityDepth):
        return value_of(given, values)
    volume = share / solid.density
    k = linear.product(volume, solid.conductivity.of(np.array(T))) / volume.sum()
    rho_c = linear.product(share, solid.specific_heat.of(np.array(T))) / volume.sum()
    return float(value_of(given.cell_size_factor, values) * np.sqrt(k / rho_c))
