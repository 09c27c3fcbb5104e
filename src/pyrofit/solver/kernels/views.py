"""Descriptions with the lanes as numbers: those of group g of many, or the only one, g none."""

from numba import types
from numba.extending import overload

from pyrofit.compiled.jit import making
from pyrofit.solver.arrays import Description, Exposure, Material, Network, Surface
from pyrofit.solver.kernels.lanes import in_lanes


def of_group(array, g):
    """Return the part of an array that belongs to a group."""
    return array if g is None else array[g]


@overload(of_group)
def _of_group(array, g):
    if isinstance(g, types.NoneType):
        return lambda array, g: array
    return lambda array, g: array[g]


@making
def _lanes(width, g, array):
    return in_lanes(width, of_group(array, g))


@making
def _surface(width, g, side):
    return Surface(
        h_cube_root=_lanes(width, g, side.h_cube_root),
        gas_rise=_lanes(width, g, side.gas_rise),
        gas_rise_time=_lanes(width, g, side.gas_rise_time),
    )


@making
def _exposure(width, g, exposure):
    return Exposure(
        front=_surface(width, g, exposure.front),
        back=_surface(width, g, exposure.back),
        schedule=_lanes(width, g, exposure.schedule),
        rise_time=_lanes(width, g, exposure.rise_time),
        drift=_lanes(width, g, exposure.drift),
        drift_time=_lanes(width, g, exposure.drift_time),
        back_emissivity=_lanes(width, g, exposure.back_emissivity),
        foil_capacity=_lanes(width, g, exposure.foil_capacity),
        contact_resistance=_lanes(width, g, exposure.contact_resistance),
        back_absorbs=exposure.back_absorbs,
        surface_share=_lanes(width, g, exposure.surface_share),
        gas_heat=_lanes(width, g, exposure.gas_heat),
        mixing_depth=_lanes(width, g, exposure.mixing_depth),
        emissivity_change=_lanes(width, g, exposure.emissivity_change),
        backing_mass=_lanes(width, g, exposure.backing_mass),
        backing_thickness=_lanes(width, g, exposure.backing_thickness),
        backing_cells=_lanes(width, g, exposure.backing_cells),
        edge_exchange=_lanes(width, g, exposure.edge_exchange),
        edge_temperature=_lanes(width, g, exposure.edge_temperature),
    )


@making
def _material(width, g, material):
    return Material(
        specific_volume=_lanes(width, g, material.specific_volume),
        expansion=_lanes(width, g, material.expansion),
        conductivity=_lanes(width, g, material.conductivity),
        specific_heat=_lanes(width, g, material.specific_heat),
        emissivity=_lanes(width, g, material.emissivity),
        absorption=_lanes(width, g, material.absorption),
        alike=material.alike,
        constant=material.constant,
    )


@making
def network_in_lanes(width, g, network):
    """Return the reactions with the lanes as numbers."""
    return Network(
        reactant=network.reactant,
        root_factor=_lanes(width, g, network.root_factor),
        activation_temperature=_lanes(width, g, network.activation_temperature),
        order=_lanes(width, g, network.order),
        catalysis=_lanes(width, g, network.catalysis),
        oxygen_order=_lanes(width, g, network.oxygen_order),
        oxygen_fall=_lanes(width, g, network.oxygen_fall),
        oxygen_use=_lanes(width, g, network.oxygen_use),
        heat=_lanes(width, g, network.heat),
        yields=_lanes(width, g, network.yields),
        gas=_lanes(width, g, network.gas),
        combustion=_lanes(width, g, network.combustion),
        glow=_lanes(width, g, network.glow),
        burns=network.burns,
        oxidises=network.oxidises,
        first_order=network.first_order,
        catalysed=network.catalysed,
        plain=network.plain,
        residue=network.residue,
        residue_yield=_lanes(width, g, network.residue_yield),
    )


@making
def in_lanes_of_group(width, g, description):
    """Return the description with the lanes as numbers."""
    return Description(
        _material(width, g, description.material),
        network_in_lanes(width, g, description.network),
        _exposure(width, g, description.exposure),
    )
