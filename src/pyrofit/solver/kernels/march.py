"""One-dimensional pyrolysing slab: Lagrangian cells, BDF2, error-controlled steps.

Every cell keeps its masses m_i [kg/m2] and its temperature T. A step from t to t + dt
1. extrapolates T linearly to T*, and takes the rates k_j(T*) with the in-cell factor sinh(s)/s;
2. predicts the masses with the logarithmic mean of k_j;
3. solves C dT/dt = conduction + radiation - sum_j dh_j r_j for T, implicitly, the reaction heat
   linearised about T* (one tridiagonal solve, surface and foil included);
4. corrects the rates and masses with the T found.
The difference between predicted and corrected mass loss rate controls dt. A cell whose reactant is
gone and whose residue is thin leaves the grid and becomes part of the skin. The skin is a
resistance in front of, and a heat capacity on, the first live cell.

Several parameter sets run side by side, each in a lane of its own (`lanes`), with its own steps,
flux, burn-out and failure. A lane that has ended, or whose step was refused, keeps its state.
"""

from pyrofit.compiled.jit import inner, loop
from pyrofit.solver.arrays import Status
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.bdf import energy_error, rejected, step_ratio
from pyrofit.solver.kernels.heat import Edge
from pyrofit.solver.kernels.lanes import in_lane, opposite, somewhere, where, with_lane
from pyrofit.solver.kernels.progress import ended, moved, next_clock, started, tried
from pyrofit.solver.kernels.state import (
    OWN,
    accept,
    begin,
    drop_thin,
    is_burnt_out,
    may_be_burnt,
    may_drop,
    size_of,
    total_mass,
)
from pyrofit.solver.kernels.step import advance, first_wide
from pyrofit.solver.kernels.trace import (
    ENERGY_ERROR,
    MASS_ERROR,
    STATUS,
    STEPS,
    compact,
    record,
    record_probes,
)

BURNT_FRACTION = 1.0e-5
"""Reactant left in the sample, relative to its initial mass, at which it counts as burnt out."""
OK, UNBURNT = float(Status.OK), float(Status.UNBURNT)


@inner
def edge_of(at, firsts):
    """Return where the sample begins in each lane."""
    first = firsts[0]
    last = firsts[0]
    for lane in range(firsts.size):
        first = min(first, firsts[lane])
        last = max(last, firsts[lane])
        at = with_lane(at, lane, float(firsts[lane]))
    return Edge(first, last + 1, at)


@inner
def as_led(ratio, running):
    """Return the ratio of the first lane in every lane, as long as that one runs."""
    if in_lane(where(running, 1.0, 0.0 * ratio), 0) == 1.0:
        return where(running, in_lane(ratio, 0), ratio)
    return ratio


@inner
def drop(taken, firsts, flat, network, led):
    """Move thin cells to the skin where a step was taken; return the heat stored by that.

    Lanes that are led move as many as the first one does, as long as that runs.
    """
    heat, count = 0.0 * taken, OWN
    for lane in range(firsts.size):
        if in_lane(taken, lane) == 1.0:
            first = firsts[lane]
            firsts[lane], moved_heat = drop_thin(flat, lane, first, network, count)
            heat = with_lane(heat, lane, moved_heat)
            if led and lane == 0:
                count = firsts[lane] - first
    return heat


@inner
def burnt_out(taken, now, firsts, arrays, network, led):
    """Return the status, OK in the lanes that a step has burnt out.

    Lanes that are led are burnt out with the first one.
    """
    status = now.status
    limit = BURNT_FRACTION * now.mass
    maybe = (taken == 1.0) & (status == UNBURNT) & may_be_burnt(arrays.work, limit, network)
    if somewhere(maybe):
        asked = where(maybe, 1.0, 0.0 * taken)
        for lane in range(firsts.size):
            if in_lane(asked, lane) == 1.0 and is_burnt_out(
                arrays.flat, lane, firsts[lane], network, in_lane(limit, lane)
            ):
                status = with_lane(status, lane, OK)
    if led and in_lane(now.status, 0) == UNBURNT:
        fine = now.running & (status <= UNBURNT)
        status = where(fine, in_lane(status, 0), status)
    return status


@inner
def conclude(outcome, now, left):
    """Write the outcomes of the runs, of which the mass ``left`` remains [kg/m2]."""
    mass_error = abs(left + now.balance.released - now.mass) / now.mass
    off = energy_error(now.balance)
    for lane in range(outcome.shape[0]):
        outcome[lane, STATUS] = in_lane(now.status, lane)
        outcome[lane, STEPS] = in_lane(now.steps, lane)
        outcome[lane, ENERGY_ERROR] = in_lane(off, lane)
        outcome[lane, MASS_ERROR] = in_lane(mass_error, lane)


@loop
def march(T_start, firsts, empty, description, numerics, end, probes, arrays, written):
    """Step all lanes from 0 to their ends; fill trace and outcome.

    ``T_start``, the description and the end have the lanes as numbers. ``firsts`` holds the first
    cell of each lane on the grid, and changes; ``empty`` the empty cells in front.
    """
    flat, work, trace = arrays.flat, arrays.work, written.trace
    network, exposure = description.network, description.exposure
    edge = edge_of(T_start, firsts)
    begin(work, arrays.wide, description, T_start)
    mass = total_mass(work) - exposure.backing_mass
    now = started(mass, T_start, exposure, numerics, end)
    none = 0.0 * T_start
    size = size_of(work, edge.first, T_start, description)
    record(trace, 0, none + 1.0, now, T_start, (none, none), size)
    record_probes(trace, 0, now.top.front, size, flat, firsts, empty, probes)
    rows = 1
    while somewhere(now.running):
        step = advance(arrays, edge, now, description)
        now = tried(now, step.status)
        ratio = step_ratio(step.error, numerics.tolerance)
        if numerics.led:
            ratio = as_led(ratio, now.running)
        again = rejected(now.clock, ratio, numerics.first_step)
        accepted = now.running & opposite(again)
        taken = where(accepted, 1.0, none)
        accept(arrays.wide, first_wide(arrays, edge), network, accepted)
        if trace.sized:
            size = size_of(work, edge.first, step.front, description)
        heat = none
        if may_drop(work, edge, taken, network):
            heat = drop(taken, firsts, flat, network, numerics.led)
            edge = edge_of(T_start, firsts)
        clock = next_clock(now, again, ratio, exposure, numerics, end)
        now = moved(now, step, accepted, heat, clock)
        back = work.cell[row.T, work.m.shape[1]]
        record(trace, rows, taken, now, back, (step.rate, step.power), size)
        record_probes(trace, rows, step.front, size, flat, firsts, empty, probes)
        rows += 1
        burnt = burnt_out(taken, now, firsts, arrays, network, numerics.led)
        now = ended(now, burnt, numerics, end)
    conclude(written.outcome, now, total_mass(work) - exposure.backing_mass)
    compact(trace.flat, rows)
