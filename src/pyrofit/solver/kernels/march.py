"""One-dimensional pyrolysing slab: Lagrangian cells, BDF2, error-controlled steps.

Every cell keeps its masses m_i [kg/m2] and its temperature T. A step from t to t + dt
1. extrapolates T linearly to T*, and takes the rates k_j(T*) with the in-cell factor sinh(s)/s;
2. predicts the masses with the logarithmic mean of k_j;
3. solves C dT/dt = conduction + radiation - sum_j dh_j r_j for T, implicitly, the reaction heat
   linearised about T* (one tridiagonal solve, surface and foil included);
4. corrects the rates and masses with the T found.
The difference between predicted and corrected mass loss rate controls dt. A cell whose reactant is
gone and whose residue is thin leaves the grid and becomes part of the skin: a resistance in front
of, and a heat capacity on, the first live cell.

Several parameter sets run side by side, each in a lane of its own (`lanes`), with its own steps,
flux, burn-out and failure. A lane that has ended, or whose step was refused, keeps its state.
"""

from pyrofit.solver.arrays import FLAME, FLUX, Status
from pyrofit.solver.kernels.bdf import (
    Balance,
    booked,
    either,
    energy_error,
    kept,
    rejected,
    retry,
    start_clock,
    step_ratio,
    tick,
)
from pyrofit.solver.kernels.heat import Edge
from pyrofit.solver.kernels.jit import inner, loop
from pyrofit.solver.kernels.lanes import in_lane, opposite, somewhere, where, with_lane
from pyrofit.solver.kernels.state import (
    accept,
    begin,
    drop_thin,
    is_burnt_out,
    thickness,
    total_mass,
)
from pyrofit.solver.kernels.step import Top, advance
from pyrofit.solver.kernels.trace import ENERGY_ERROR, MASS_ERROR, STATUS, STEPS, record

GASIFICATION_SCALE = 2.0e6
"""Heat of gasification [J/kg] that turns the flux into the mass loss rate it could sustain."""
LEAST_FLUX_SCALE = 5.0e3
"""[W/m2]; keeps that rate above zero without external flux."""
ONSET_SHARE = 0.01
"""Share of that rate to which the error of a step is compared at least."""
PEAK_MULTIPLE = 2.0
"""The error is compared to this multiple of the largest rate so far."""
BURNT_FRACTION = 1.0e-5
"""Reactant left in the sample, relative to its initial mass, at which it counts as burnt out."""
OK, UNBURNT = float(Status.OK), float(Status.UNBURNT)
TOO_MANY_STEPS = float(Status.TOO_MANY_STEPS)


@inner
def scale_of_rate(exposure):
    """Return the mass loss rate to which the error is compared at the onset [kg/(m2 s)]."""
    schedule = exposure.schedule
    flux = LEAST_FLUX_SCALE + 0.0 * schedule[FLUX, 0]
    for p in range(schedule.shape[1]):
        flux = max(flux, schedule[FLUX, p] + schedule[FLAME, p])
    return ONSET_SHARE * flux / GASIFICATION_SCALE


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


@loop
def march(
    start,
    empty,
    firsts,
    T_start,
    material,
    network,
    exposure,
    numerics,
    t_end,
    stop_when_burnt,
    probes,
    flat,
    work,
    wide,
    room,
    trace,
    outcome,
):
    """Step all lanes from 0 to their ends; fill trace and outcome."""
    edge = edge_of(T_start, firsts)
    begin(work, wide, material, network, exposure, T_start)
    none = 0.0 * T_start
    top = Top(T_start, T_start, none + 1.0, none)
    balance = Balance(none, none, none, none, none, none)
    clock = start_clock(none, exposure, numerics, t_end)
    rate_scale = scale_of_rate(exposure)
    mass = total_mass(work) - exposure.backing_mass
    depth, d_skin, r_skin = thickness(work, edge.first, material, T_start)
    depth = depth - exposure.backing_thickness
    at_start = none, none, none, T_start, depth, none, none, clock.dt_old, d_skin, r_skin
    for lane in range(firsts.size):
        record(trace[lane, 0], lane, at_start, flat, firsts[lane], empty, probes)
    status, steps, tries = none + UNBURNT, none, none
    running = clock.t < t_end - 1e-9
    while somewhere(running):
        step = advance(
            work, wide, edge, top, clock, mass, rate_scale, room, material, network, exposure
        )
        tries += where(running, 1.0, 0.0)
        fine = step.status == OK
        status = where(running & opposite(fine), step.status, status)
        running = running & fine
        ratio = step_ratio(step.error, numerics.tolerance)
        again = rejected(clock, ratio, numerics.first_step)
        accepted = running & opposite(again)
        block = edge.first * wide.m.shape[1] // work.m.shape[1]
        accept(wide, block, network, accepted)
        depth, d_skin, r_skin = thickness(work, edge.first, material, step.front)
        depth = depth - exposure.backing_thickness
        rate_scale = where(accepted, max(rate_scale, PEAK_MULTIPLE * step.rate), rate_scale)
        taken = where(accepted, 1.0, none)
        steps += taken
        heat = none
        for lane in range(firsts.size):
            if in_lane(taken, lane) == 1.0:
                firsts[lane], moved = drop_thin(flat, lane, firsts[lane], start, network)
                heat = with_lane(heat, lane, moved)
        edge = edge_of(T_start, firsts)
        after = booked(balance, clock, step.gas, step.burnt, step.heat + heat, step.net_flux)
        balance = kept(accepted, after, balance)
        top = Top(
            where(accepted, step.front, top.front),
            where(accepted, top.front, top.front_old),
            where(running, step.eps, top.eps),
            balance.released / mass,
        )
        next_clock = either(
            again,
            retry(clock, ratio, numerics.first_step, exposure.schedule),
            tick(clock, ratio, exposure, numerics, t_end),
        )
        clock = either(running, next_clock, clock)
        gone = balance.released, step.rate
        burnt = balance.burnt, step.power
        now = clock.t, *gone, top.front, depth, *burnt, clock.dt_old, d_skin, r_skin
        for lane in range(firsts.size):
            if in_lane(taken, lane) == 1.0:
                first = firsts[lane]
                at = int(in_lane(steps, lane))
                record(trace[lane, at], lane, now, flat, first, empty, probes)
                if in_lane(status, lane) == UNBURNT:
                    limit = BURNT_FRACTION * in_lane(mass, lane)
                    if is_burnt_out(flat, lane, first, network, limit):
                        status = with_lane(status, lane, OK)
        running = running & (clock.t < t_end - 1e-9)
        if stop_when_burnt:
            running = running & (status != OK)
        most = 1.0 * numerics.most_steps
        many = running & ((steps >= most) | (tries >= 2.0 * most))
        status = where(many, TOO_MANY_STEPS, status)
        running = running & opposite(many)
    left = total_mass(work) - exposure.backing_mass
    mass_error = abs(left + balance.released - mass) / mass
    off = energy_error(balance)
    for lane in range(firsts.size):
        outcome[lane, STATUS] = in_lane(status, lane)
        outcome[lane, STEPS] = in_lane(steps, lane)
        outcome[lane, ENERGY_ERROR] = in_lane(off, lane)
        outcome[lane, MASS_ERROR] = in_lane(mass_error, lane)
