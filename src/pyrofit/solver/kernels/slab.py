"""The slab as Python calls it: one set, or groups of sets that run side by side."""

import numpy as np

from pyrofit.compiled.jit import entry, making
from pyrofit.solver.arrays import End, Probes, Start
from pyrofit.solver.kernels.lanes import in_lanes
from pyrofit.solver.kernels.march import march
from pyrofit.solver.kernels.output import sample
from pyrofit.solver.kernels.state import fill
from pyrofit.solver.kernels.trace import PROBES, THICKNESS, Trace, Written
from pyrofit.solver.kernels.views import in_lanes_of_group
from pyrofit.solver.kernels.work import make_arrays


@making
def make_trace(width, numerics, probes, asked):
    """Return room for the traces of a group of runs."""
    inside = probes.material.shape[-1] + probes.fixture.shape[-1]
    sized = inside > 0
    for column in asked.column:
        sized = sized or column == THICKNESS
    # A run ends after twice as many tries as it may take steps.
    flat = np.empty((2 * numerics.most_steps + 2, PROBES + inside, len(width)))
    return Trace(flat, in_lanes(width, flat), sized)


@making
def run(width, wide, g, start, description, numerics, end, probes, written):
    """Run one group of samples, see `slab`; the description is that of group g, or of all."""
    cells, components = start.mass.shape[0], start.mass.shape[1]
    reactions = description.network.reactant.size
    arrays = make_arrays(width, wide, cells, components, reactions)
    fill(arrays.work, in_lanes(width, start.mass))
    march(
        in_lanes(width, start.temperature),
        start.empty.copy(),
        start.empty,
        in_lanes_of_group(width, g, description),
        numerics,
        End(in_lanes(width, end.time), end.when_burnt),
        probes,
        arrays,
        written,
    )


@entry
def slab(width, wide, start, description, numerics, end, probes, asked, at):
    """Run samples side by side, each under its own exposure.

    Parameters
    ----------
    width, wide : tuples whose lengths, parts of the compiled code, are the number of lanes, and of
        numbers in a register; these are the same, or there is one lane.
    start : see `pyrofit.solver.arrays.Start`. A lane that needs fewer cells than others begins with
        empty ones. Their number times that of the lanes is a multiple of the numbers in a register.
    description, numerics, end, probes, asked : see `pyrofit.solver.arrays`.
    at : times of all signals [s], shape (lanes, points).

    Returns
    -------
    signals, shape (lanes, points); outcome, shape (lanes, 4): status, steps, energy error
    (imbalance relative to the heat that crossed the surfaces), mass error (relative).
    """
    lanes = len(width)
    trace = make_trace(width, numerics, probes, asked)
    outcome = np.empty((lanes, 4))
    signals = np.empty(at.shape)
    written = Written(trace, outcome)
    run(width, wide, None, start, description, numerics, end, probes, written)
    sample(trace.flat, outcome, asked, at, signals)
    return signals, outcome


@entry
def slabs(width, start, description, numerics, end, probes, asked, at):
    """Run groups of samples one after the other: as `slab`, with an axis more ahead, the groups."""
    groups, lanes = end.time.shape
    trace = make_trace(width, numerics, probes, asked)
    outcome = np.empty((groups, lanes, 4))
    signals = np.empty(at.shape)
    for g in range(groups):
        empty = start.empty[g]
        spare = empty.min()
        run(
            width,
            width,
            g,
            Start(start.mass[g, spare:], empty - spare, start.temperature[g]),
            description,
            numerics,
            End(end.time[g], end.when_burnt),
            Probes(probes.material[g], probes.fixture[g]),
            Written(trace, outcome[g]),
        )
        sample(trace.flat, outcome[g], asked, at[g], signals[g])
    return signals, outcome
