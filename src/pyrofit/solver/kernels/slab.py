"""The slab as Python calls it: one set, or groups of sets that run side by side."""

import numpy as np

from pyrofit.solver.arrays import Probes
from pyrofit.solver.kernels.jit import entry, inner, making
from pyrofit.solver.kernels.lanes import in_lanes
from pyrofit.solver.kernels.march import march
from pyrofit.solver.kernels.output import sample
from pyrofit.solver.kernels.state import fill
from pyrofit.solver.kernels.trace import PROBES
from pyrofit.solver.kernels.views import exposure_in_lanes, material_in_lanes, network_in_lanes
from pyrofit.solver.kernels.work import allocate, in_width, make_room


@inner
def columns(probes):
    """Return how many columns a trace has."""
    return PROBES + probes.material.shape[-1] + probes.fixture.shape[-1]


@making
def run(
    width,
    wide,
    g,
    start,
    empty,
    T_start,
    material,
    network,
    exposure,
    numerics,
    t_end,
    stop_when_burnt,
    probes,
    trace,
    outcome,
):
    """Run one group of samples, see `slab`; the description is that of group g, or of all."""
    lanes = len(width)
    cells, components = start.shape[0], start.shape[1]
    reactions = network.reactant.size
    flat = allocate(cells, len(wide) // lanes, components, reactions, lanes)
    work = in_width(width, flat)
    fill(work, in_lanes(width, start))
    march(
        start,
        empty,
        empty.copy(),
        in_lanes(width, T_start),
        material_in_lanes(width, g, material),
        network_in_lanes(width, g, network),
        exposure_in_lanes(width, g, exposure),
        numerics,
        in_lanes(width, t_end),
        stop_when_burnt,
        probes,
        flat,
        work,
        in_width(wide, flat),
        make_room(wide, reactions),
        trace,
        outcome,
    )


@entry
def slab(
    width,
    wide,
    start,
    empty,
    T_start,
    material,
    network,
    exposure,
    numerics,
    t_end,
    stop_when_burnt,
    probes,
    asked,
    at,
):
    """Run samples side by side, each under its own exposure.

    Parameters
    ----------
    width, wide : tuples whose lengths, parts of the compiled code, are the number of lanes, and of
        numbers in a register; these are the same, or there is one lane.
    start : initial masses of the cells [kg/m2], shape (cells, components, lanes), front first; a
        lane that needs fewer cells begins with empty ones. Their number times that of the lanes
        is a multiple of the numbers in a register.
    empty : number of empty cells, shape (lanes,).
    T_start : initial temperature [K], shape (lanes,).
    material, network, exposure, numerics : see `pyrofit.solver.arrays`.
    t_end : end of the run [s], shape (lanes,).
    stop_when_burnt : end as soon as the reactant is gone.
    probes : see `pyrofit.solver.arrays.Probes`.
    asked : see `pyrofit.solver.arrays.Asked`.
    at : times of all signals [s], shape (lanes, points).

    Returns
    -------
    signals, shape (lanes, points); outcome, shape (lanes, 4): status, steps, energy error
    (imbalance relative to the heat that crossed the surfaces), mass error (relative).
    """
    lanes = len(width)
    trace = np.empty((lanes, numerics.most_steps + 1, columns(probes)))
    outcome = np.empty((lanes, 4))
    signals = np.empty(at.shape)
    run(
        width,
        wide,
        None,
        start,
        empty,
        T_start,
        material,
        network,
        exposure,
        numerics,
        t_end,
        stop_when_burnt,
        probes,
        trace,
        outcome,
    )
    sample(trace, outcome, asked, at, signals)
    return signals, outcome


@entry
def slabs(
    width,
    start,
    empty,
    T_start,
    material,
    network,
    exposure,
    numerics,
    t_end,
    stop_when_burnt,
    probes,
    asked,
    at,
):
    """Run groups of samples one after the other: as `slab`, with an axis more ahead, the groups."""
    groups, lanes = t_end.shape
    trace = np.empty((lanes, numerics.most_steps + 1, columns(probes)))
    outcome = np.empty((groups, lanes, 4))
    signals = np.empty(at.shape)
    for g in range(groups):
        spare = empty[g].min()
        run(
            width,
            width,
            g,
            start[g, spare:],
            empty[g] - spare,
            T_start[g],
            material,
            network,
            exposure,
            numerics,
            t_end[g],
            stop_when_burnt,
            Probes(probes.material[g], probes.fixture[g]),
            trace,
            outcome[g],
        )
        sample(trace, outcome[g], asked, at[g], signals[g])
    return signals, outcome
