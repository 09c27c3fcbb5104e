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

import math

import numpy as np

from pyrofit.solver.arrays import Exposure, Material, Network, Status, Surface
from pyrofit.solver.kernels import row
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
from pyrofit.solver.kernels.cells import describe, layer, rate_constants, reactant_left
from pyrofit.solver.kernels.heat import Edge
from pyrofit.solver.kernels.jit import entry, inner, live, loop, making
from pyrofit.solver.kernels.lanes import in_lane, in_lanes, opposite, somewhere, where, with_lane
from pyrofit.solver.kernels.step import Top, advance, summed
from pyrofit.solver.kernels.work import allocate, in_width, make_room

GASIFICATION_SCALE = 2.0e6
"""Heat of gasification [J/kg] that turns the flux into the mass loss rate it could sustain."""
LEAST_FLUX_SCALE = 5.0e3
"""[W/m2]; keeps that rate above zero without external flux."""
ONSET_SHARE = 0.01
"""Share of that rate to which the error of a step is compared at least."""
PEAK_MULTIPLE = 2.0
"""The error is compared to this multiple of the largest rate so far."""
DEAD_FRACTION = 1.0e-7
"""Reactant left, relative to the cell's initial mass, below which a cell may leave the grid."""
THIN_FRACTION = 0.01
"""Residue thickness, relative to the cell's initial one, below which a cell may leave the grid."""
BURNT_FRACTION = 1.0e-5
"""Reactant left in the sample, relative to its initial mass, at which it counts as burnt out."""
OK, UNBURNT = float(Status.OK), float(Status.UNBURNT)
TOO_MANY_STEPS = float(Status.TOO_MANY_STEPS)
TIME, RELEASED, RATE, FRONT, BACK, THICKNESS, PROBES = range(7)
"""Columns of the trace; any number of probes."""
STATUS, STEPS, ENERGY_ERROR, MASS_ERROR = range(4)
"""Columns of what a run came to."""


@inner
def begin(work, wide, material, network, exposure, T_start):
    """Fill temperatures, properties and rates of the initial state."""
    cell = work.cell
    foil = work.m.shape[1]
    for n in live(cell, 0):
        cell[row.T, n] = T_start
        cell[row.T_old, n] = T_start
        cell[row.T_star, n] = T_start
    describe(wide, 0, material)
    rate_constants(wide, 0, network)
    for n in live(wide.m, 0):
        wide.cell[row.C, n] = wide.cell[row.C_new, n]
        wide.cell[row.d_start, n] = wide.cell[row.d, n]
        for j in range(wide.root.shape[0]):
            wide.root[j, n] = wide.root_new[j, n]
    cell[row.C_new, foil] = exposure.foil_capacity
    cell[row.C, foil] = exposure.foil_capacity
    cell[row.half_r, foil] = exposure.contact_resistance


@inner
def fill(work, start):
    """Give the cells their masses."""
    for i in range(work.m.shape[0]):
        for n in live(work.m, 0):
            work.m[i, n] = start[n, i]
            work.m_new[i, n] = start[n, i]
            work.formed[i, n] = start[n, i]


@loop
def accept(wide, first, network, accepted):
    """Make the state after the step the current one, in the lanes in which it was accepted."""
    cell = wide.cell
    for n in live(cell, first):
        cell[row.T_old, n] = where(accepted, cell[row.T, n], cell[row.T_old, n])
        cell[row.T, n] = where(accepted, cell[row.T_new, n], cell[row.T, n])
    for n in live(wide.m, first):
        cell[row.C, n] = where(accepted, cell[row.C_new, n], cell[row.C, n])
        cell[row.heat, n] = where(accepted, cell[row.heat_new, n], cell[row.heat, n])
    for i in range(wide.m.shape[0]):
        for n in live(wide.m, first):
            wide.m[i, n] = where(accepted, wide.m_new[i, n], wide.m[i, n])
    for j in range(wide.root.shape[0]):
        for n in live(wide.m, first):
            wide.root[j, n] = where(accepted, wide.root_new[j, n], wide.root[j, n])
    if not network.first_order:
        for i in range(wide.m.shape[0]):
            for n in live(wide.m, first):
                wide.formed[i, n] = where(accepted, wide.formed_new[i, n], wide.formed[i, n])


@inner
def drop_thin(flat, lane, first, start, network):
    """Move cells that are burnt and thin to the skin; return the first one left, heat stored."""
    cell = flat.cell
    heat = 0.0
    while first < start.shape[0] - 1:
        total = 0.0
        for i in range(start.shape[1]):
            total += start[first, i, lane]
        burnt = reactant_left(flat.m, first, lane, network) < DEAD_FRACTION * total
        thin = THIN_FRACTION * cell[row.d_start, first, lane]
        if not burnt or cell[row.d, first, lane] > thin:
            break
        for i in range(start.shape[1]):
            flat.skin[i, 0, lane] += flat.m[i, first, lane]
            flat.m[i, first, lane] = 0.0
        C = cell[row.C, first, lane]
        cell[row.d, first, lane] = 0.0
        cell[row.C, first, lane] = 0.0
        cell[row.C, first + 1, lane] += C
        heat += C * (cell[row.T, first + 1, lane] - cell[row.T, first, lane])
        first += 1
    return first, heat


@inner
def is_burnt_out(flat, lane, first, network, limit):
    """Tell whether no more reactant than the limit [kg/m2] is left."""
    left = 0.0
    for n in range(flat.m.shape[1] - 1, first - 1, -1):
        left += reactant_left(flat.m, n, lane, network)
        if left > limit:
            return False
    return True


@inner
def total_mass(work):
    """Return the mass of all cells and of the skin [kg/m2]."""
    mass = 0.0 * work.skin[0, 0]
    for i in range(work.m.shape[0]):
        mass += work.skin[i, 0]
        for n in live(work.m, 0):
            mass += work.m[i, n]
    return mass


@inner
def thickness(work, first, material, T):
    """Return the thickness of all cells and of the skin [m]."""
    skin, _, _ = layer(work.skin, 0, material, T)
    return skin + summed(work, row.d, first)


@inner
def scale_of_rate(exposure):
    """Return the mass loss rate to which the error is compared at the onset [kg/(m2 s)]."""
    flux = LEAST_FLUX_SCALE + 0.0 * exposure.flux[0]
    for p in range(exposure.flux.size):
        flux = max(flux, exposure.flux[p])
    return ONSET_SHARE * flux / GASIFICATION_SCALE


@inner
def probe_temperature(position, ahead, cell, foil, lane, first, front):
    """Return T at a Lagrangian position, linear between centres.

    It is counted in cells from the front of the virgin sample, ``ahead`` of which are empty ones.
    """
    below = math.floor(position - 0.5)
    part = position - 0.5 - below
    low = below + ahead
    gone = first - ahead
    if position <= gone:
        return front
    if low < first:
        return front + (cell[row.T, first, lane] - front) * (position - gone) / 0.5
    if low >= foil - 1:
        half, contact = cell[row.half_r, foil - 1, lane], cell[row.half_r, foil, lane]
        part = (position - (foil - ahead) + 0.5) / 0.5 * (half / (half + contact))
        low = foil - 1
    here = cell[row.T, low, lane]
    return here + part * (cell[row.T, low + 1, lane] - here)


@inner
def record(trace, lane, t, released, rate, front, depth, flat, first, ahead, probes):
    """Write one row of the trace of a lane."""
    foil = flat.m.shape[1]
    trace[TIME] = in_lane(t, lane)
    trace[RELEASED] = in_lane(released, lane)
    trace[RATE] = in_lane(rate, lane)
    trace[FRONT] = in_lane(front, lane)
    trace[BACK] = flat.cell[row.T, foil, lane]
    trace[THICKNESS] = in_lane(depth, lane)
    for a in range(probes.shape[1]):
        trace[PROBES + a] = probe_temperature(
            probes[lane, a], ahead[lane], flat.cell, foil, lane, first, in_lane(front, lane)
        )


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
    balance = Balance(none, none, none, none, none)
    clock = start_clock(none, exposure, numerics, t_end)
    rate_scale = scale_of_rate(exposure)
    mass = total_mass(work)
    depth = thickness(work, edge.first, material, T_start)
    for lane in range(firsts.size):
        record(
            trace[lane, 0],
            lane,
            none,
            none,
            none,
            T_start,
            depth,
            flat,
            firsts[lane],
            empty,
            probes,
        )
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
        depth = thickness(work, edge.first, material, step.front)
        rate_scale = where(accepted, max(rate_scale, PEAK_MULTIPLE * step.rate), rate_scale)
        taken = where(accepted, 1.0, none)
        steps += taken
        heat = none
        for lane in range(firsts.size):
            if in_lane(taken, lane) == 1.0:
                firsts[lane], moved = drop_thin(flat, lane, firsts[lane], start, network)
                heat = with_lane(heat, lane, moved)
        edge = edge_of(T_start, firsts)
        balance = kept(
            accepted, booked(balance, clock, step.gas, step.heat + heat, step.net_flux), balance
        )
        top = Top(
            where(accepted, step.front, top.front),
            where(accepted, top.front, top.front_old),
            where(running, step.eps, top.eps),
            balance.released / mass,
        )
        next_clock = either(
            again,
            retry(clock, ratio, numerics.first_step),
            tick(clock, ratio, exposure, numerics, t_end),
        )
        clock = either(running, next_clock, clock)
        for lane in range(firsts.size):
            if in_lane(taken, lane) == 1.0:
                first = firsts[lane]
                at = int(in_lane(steps, lane))
                record(
                    trace[lane, at],
                    lane,
                    clock.t,
                    balance.released,
                    step.rate,
                    top.front,
                    depth,
                    flat,
                    first,
                    empty,
                    probes,
                )
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
    mass_error = abs(total_mass(work) + balance.released - mass) / mass
    off = energy_error(balance)
    for lane in range(firsts.size):
        outcome[lane, STATUS] = in_lane(status, lane)
        outcome[lane, STEPS] = in_lane(steps, lane)
        outcome[lane, ENERGY_ERROR] = in_lane(off, lane)
        outcome[lane, MASS_ERROR] = in_lane(mass_error, lane)


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
def _exposure(width, exposure):
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
def _material(width, material):
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
    probes : Lagrangian positions of temperature probes, in cells that are not empty, shape
        (lanes, probes).

    Returns
    -------
    trace, shape (lanes, steps, columns), of which each lane fills as many rows as it took steps,
    and one before; outcome, shape (lanes, 4): status, steps, energy error (imbalance relative to
    the heat that crossed the surfaces), mass error (relative).
    """
    lanes = len(width)
    cells, components = start.shape[0], start.shape[1]
    reactions = network.reactant.size
    flat = allocate(cells, len(wide) // lanes, components, reactions, lanes)
    work = in_width(width, flat)
    fill(work, in_lanes(width, start))
    trace = np.empty((lanes, numerics.most_steps + 1, PROBES + probes.shape[1]))
    outcome = np.empty((lanes, 4))
    march(
        start,
        empty,
        empty.copy(),
        in_lanes(width, T_start),
        _material(width, material),
        network_in_lanes(width, network),
        _exposure(width, exposure),
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
    return trace, outcome
