"""Descriptions with the lanes as numbers, and those of one group of many."""

from pyrofit.solver.arrays import Exposure, Material, Network, Surface
from pyrofit.solver.kernels.jit import making
from pyrofit.solver.kernels.lanes import in_lanes


@making
def _surface(width, side):
    return Surface(
        h=in_lanes(width, side.h),
        h_cube_root=in_lanes(width, side.h_cube_root),
        gas_temperature=in_lanes(width, side.gas_temperature),
        gas_rise=in_lanes(width, side.gas_rise),
        gas_rise_time=in_lanes(width, side.gas_rise_time),
        wall_temperature=in_lanes(width, side.wall_temperature),
    )


@making
def exposure_in_lanes(width, exposure):
    """Return what acts on the samples with the lanes as numbers."""
    return Exposure(
        front=_surface(width, exposure.front),
        back=_surface(width, exposure.back),
        flux_time=in_lanes(width, exposure.flux_time),
        flux=in_lanes(width, exposure.flux),
        rise_time=in_lanes(width, exposure.rise_time),
        drift=in_lanes(width, exposure.drift),
        drift_time=in_lanes(width, exposure.drift_time),
        back_emissivity=in_lanes(width, exposure.back_emissivity),
        foil_capacity=in_lanes(width, exposure.foil_capacity),
        contact_resistance=in_lanes(width, exposure.contact_resistance),
        foil_opaque=exposure.foil_opaque,
        mixing_depth=in_lanes(width, exposure.mixing_depth),
        emissivity_change=in_lanes(width, exposure.emissivity_change),
        edge_exchange=in_lanes(width, exposure.edge_exchange),
        edge_temperature=in_lanes(width, exposure.edge_temperature),
    )


@making
def material_in_lanes(width, material):
    """Return the properties with the lanes as numbers."""
    return Material(
        specific_volume=in_lanes(width, material.specific_volume),
        expansion=in_lanes(width, material.expansion),
        conductivity=in_lanes(width, material.conductivity),
        specific_heat=in_lanes(width, material.specific_heat),
        emissivity=in_lanes(width, material.emissivity),
        absorption=in_lanes(width, material.absorption),
    )


@making
def network_in_lanes(width, network):
    """Return the reactions with the lanes as numbers."""
    return Network(
        reactant=network.reactant,
        root_factor=in_lanes(width, network.root_factor),
        activation_temperature=in_lanes(width, network.activation_temperature),
        order=in_lanes(width, network.order),
        heat=in_lanes(width, network.heat),
        yields=in_lanes(width, network.yields),
        gas=in_lanes(width, network.gas),
        first_order=network.first_order,
        plain=network.plain,
        residue=network.residue,
        residue_yield=in_lanes(width, network.residue_yield),
    )


@making
def _surface_of(side, g):
    return Surface(
        h=side.h[g],
        h_cube_root=side.h_cube_root[g],
        gas_temperature=side.gas_temperature[g],
        gas_rise=side.gas_rise[g],
        gas_rise_time=side.gas_rise_time[g],
        wall_temperature=side.wall_temperature[g],
    )


@making
def exposure_of(exposure, g):
    """Return what acts on the samples of a group."""
    return Exposure(
        front=_surface_of(exposure.front, g),
        back=_surface_of(exposure.back, g),
        flux_time=exposure.flux_time[g],
        flux=exposure.flux[g],
        rise_time=exposure.rise_time[g],
        drift=exposure.drift[g],
        drift_time=exposure.drift_time[g],
        back_emissivity=exposure.back_emissivity[g],
        foil_capacity=exposure.foil_capacity[g],
        contact_resistance=exposure.contact_resistance[g],
        foil_opaque=exposure.foil_opaque,
        mixing_depth=exposure.mixing_depth[g],
        emissivity_change=exposure.emissivity_change[g],
        edge_exchange=exposure.edge_exchange[g],
        edge_temperature=exposure.edge_temperature[g],
    )


@making
def material_of(material, g):
    """Return the properties of a group."""
    return Material(
        specific_volume=material.specific_volume[g],
        expansion=material.expansion[g],
        conductivity=material.conductivity[g],
        specific_heat=material.specific_heat[g],
        emissivity=material.emissivity[g],
        absorption=material.absorption[g],
    )


@making
def network_of(network, g):
    """Return the reactions of a group."""
    return Network(
        reactant=network.reactant,
        root_factor=network.root_factor[g],
        activation_temperature=network.activation_temperature[g],
        order=network.order[g],
        heat=network.heat[g],
        yields=network.yields[g],
        gas=network.gas[g],
        first_order=network.first_order,
        plain=network.plain,
        residue=network.residue,
        residue_yield=network.residue_yield[g],
    )
