"""The inert layers behind the sample as arrays, for all sets at once as in `lower`."""

import numpy as np

from pyrofit.model import material as words
from pyrofit.model.base import value_of
from pyrofit.model.slab import SlabExperiment
from pyrofit.solver.arrays import Exposure, Material, Values
from pyrofit.solver.lower_experiment import LoweredLayer
from pyrofit.solver.lower_exposure import number_of_sets, properties_at
from pyrofit.solver.lower_property import total

BACKING_TIME_S = 2.0
"""Time in which heat diffuses through a cell of a layer behind the sample."""
BACKING_CELLS = 2.0, 200.0
"""Least and most cells of such a layer."""


def lower_backing(
    experiment: SlabExperiment,
    material: words.Material,
    arrays: Material,
    values: Values,
    sets: int = 1,
    cells_factor: float = 1.0,
) -> tuple[LoweredLayer, ...]:
    """Return the inert layers behind the sample, front first, with their own numbers of cells.

    A cell is as thick as heat diffuses within `BACKING_TIME_S`, d = sqrt(k/(rho c) t).
    """
    if not experiment.sample.backing:
        return ()
    names = list(material.components)
    T = value_of(experiment.sample.initial_temperature_K, values)
    k, c = (properties_at(table, T) for table in (arrays.conductivity, arrays.specific_heat))
    layers = []
    for layer in experiment.sample.backing:
        i = names.index(layer.component)
        size = number_of_sets(value_of(layer.thickness_m, values), sets)
        mass = np.zeros((len(names), sets))
        mass[i] = size / arrays.specific_volume[i]
        depth = np.sqrt(k[i] * arrays.specific_volume[i] / c[i] * BACKING_TIME_S)
        cells = np.ceil(cells_factor * np.clip(size / depth, *BACKING_CELLS))
        layers.append(LoweredLayer(mass, size, cells))
    return tuple(layers)


def with_backing(exposure: Exposure, layers: tuple[LoweredLayer, ...]) -> Exposure:
    """Return the exposure with mass, thickness and cells of the layers behind the sample.

    The solver must tell these from the sample.
    """
    if not layers:
        return exposure
    return exposure._replace(
        backing_mass=np.asarray(sum(total(layer.mass) for layer in layers)),
        backing_thickness=np.asarray(sum(layer.thickness for layer in layers)),
        backing_cells=np.asarray(sum(layer.cells for layer in layers if layer.cells is not None)),
    )
