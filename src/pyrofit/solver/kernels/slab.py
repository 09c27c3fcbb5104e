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
"""

import math

import numpy as np

from pyrofit.solver.arrays import Status
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.bdf import (
    Balance,
    booked,
    energy_error,
    rejected,
    retry,
    start_clock,
    step_ratio,
    tick,
)
from pyrofit.solver.kernels.cells import layer, properties, rate_constants, reactant_left
from pyrofit.solver.kernels.jit import entry, inner, live, loop
from pyrofit.solver.kernels.step import Top, advance
from pyrofit.solver.kernels.work import allocate

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
OK, UNBURNT, TOO_MANY_STEPS = int(Status.OK), int(Status.UNBURNT), int(Status.TOO_MANY_STEPS)
TIME, RELEASED, RATE, FRONT, BACK, THICKNESS, PROBES = range(7)
"""Columns of the trace; any number of probes."""


@inner
def begin(work, first, material, network, exposure):
    """Fill properties and rates of the initial state."""
    cell = work.cell
    properties(work, first, material)
    rate_constants(work, first, network)
    cell[row.C_new, -1] = exposure.foil_capacity
    cell[row.half_r, -1] = exposure.contact_resistance
    for n in live(cell, first):
        cell[row.C, n] = cell[row.C_new, n]
        cell[row.d_start, n] = cell[row.d, n]
    for j in range(work.k.shape[0]):
        for n in live(work.k, first):
            work.k[j, n] = work.k_new[j, n]


@inner
def accept(work, first, network):
    """Make the state after the step the current one."""
    cell = work.cell
    for n in live(cell, first):
        cell[row.T_old, n] = cell[row.T, n]
        cell[row.T, n] = cell[row.T_new, n]
        cell[row.C, n] = cell[row.C_new, n]
        cell[row.heat, n] = cell[row.heat_new, n]
    for i in range(work.m.shape[0]):
        for n in live(work.m, first):
            work.m[i, n] = work.m_new[i, n]
    for j in range(work.k.shape[0]):
        for n in live(work.m, first):
            work.k[j, n] = work.k_new[j, n]
        if not network.first_order:
            for i in range(work.m.shape[0]):
                for n in live(work.m, first):
                    work.formed[i, n] += network.yields[j, i] * work.used[j, n]


@inner
def drop_thin(work, first, start, network):
    """Move cells that are burnt and thin to the skin; return the first one left, heat stored."""
    cell = work.cell
    heat = 0.0
    while first < start.shape[0] - 1:
        total = 0.0
        for i in range(start.shape[1]):
            total += start[first, i]
        burnt = reactant_left(work.m, first, network) < DEAD_FRACTION * total
        if not burnt or cell[row.d, first] > THIN_FRACTION * cell[row.d_start, first]:
            break
        for i in range(start.shape[1]):
            work.skin[i, 0] += work.m[i, first]
            work.m[i, first] = 0.0
        cell[row.d, first] = 0.0
        cell[row.C, first + 1] += cell[row.C, first]
        heat += cell[row.C, first] * (cell[row.T, first + 1] - cell[row.T, first])
        first += 1
    return first, heat


@inner
def is_burnt_out(work, first, network, limit):
    """Tell whether no more reactant than the limit [kg/m2] is left."""
    left = 0.0
    for n in range(work.m.shape[1] - 1, first - 1, -1):
        left += reactant_left(work.m, n, network)
        if left > limit:
            return False
    return True


@inner
def total_mass(work):
    """Return the mass of all cells and of the skin [kg/m2]."""
    mass = 0.0
    for i in range(work.m.shape[0]):
        mass += work.skin[i, 0]
        for n in range(work.m.shape[1]):
            mass += work.m[i, n]
    return mass


@inner
def thickness(work, material, T):
    """Return the thickness of all cells and of the skin [m]."""
    total, _, _ = layer(work.skin, 0, material, T)
    for n in range(work.m.shape[1]):
        total += work.cell[row.d, n]
    return total


@inner
def scale_of_rate(exposure):
    """Return the mass loss rate to which the error is compared at the onset [kg/(m2 s)]."""
    flux = LEAST_FLUX_SCALE
    for p in range(exposure.flux.size):
        flux = max(flux, exposure.flux[p])
    return ONSET_SHARE * flux / GASIFICATION_SCALE


@inner
def probe_temperature(position, cell, first, front):
    """Return T at a Lagrangian position (in cells from the front), linear between centres."""
    foil = cell.shape[1] - 1
    low = math.floor(position - 0.5)
    part = position - 0.5 - low
    if position <= first:
        return front
    if low < first:
        return front + (cell[row.T, first] - front) * (position - first) / 0.5
    if low >= foil - 1:
        half, contact = cell[row.half_r, foil - 1], cell[row.half_r, foil]
        part = (position - foil + 0.5) / 0.5 * (half / (half + contact))
        low = foil - 1
    return cell[row.T, low] + part * (cell[row.T, low + 1] - cell[row.T, low])


@inner
def record(trace, t, released, rate, front, depth, work, first, probes):
    """Write one row of the trace."""
    trace[TIME] = t
    trace[RELEASED] = released
    trace[RATE] = rate
    trace[FRONT] = front
    trace[BACK] = work.cell[row.T, -1]
    trace[THICKNESS] = depth
    for a in range(probes.size):
        trace[PROBES + a] = probe_temperature(probes[a], work.cell, first, front)


@loop
def march(
    start,
    T_start,
    material,
    network,
    exposure,
    numerics,
    t_end,
    stop_when_burnt,
    probes,
    work,
    trace,
):
    """Step from 0 to t_end; return how it ended, the number of steps, energy and mass error."""
    first = np.int64(0)  # a plain 0 is a type of its own, for which all would be compiled again
    begin(work, first, material, network, exposure)
    top = Top(T_start, T_start, 1.0, 0.0)
    balance = Balance(0.0, 0.0, 0.0, 0.0, 0.0)
    clock = start_clock(0.0, exposure, numerics, t_end)
    rate_scale = scale_of_rate(exposure)
    mass = total_mass(work)
    depth = thickness(work, material, T_start)
    record(trace[0], 0.0, 0.0, 0.0, T_start, depth, work, first, probes)
    status, steps, tries = UNBURNT, 0, 0
    while clock.t < t_end - 1e-9:
        if steps >= numerics.most_steps or tries >= 2 * numerics.most_steps:
            status = TOO_MANY_STEPS
            break
        tries += 1
        step = advance(work, first, top, clock, mass, rate_scale, material, network, exposure)
        if step.status != OK:
            status = step.status
            break
        ratio = step_ratio(step.error, numerics.tolerance)
        if rejected(clock, ratio, numerics.first_step):
            clock = retry(clock, ratio, numerics.first_step)
            top = Top(top.front, top.front_old, step.eps, top.converted)
            continue
        steps += 1
        rate_scale = max(rate_scale, PEAK_MULTIPLE * step.rate)
        accept(work, first, network)
        depth = thickness(work, material, step.front)
        first, heat = drop_thin(work, first, start, network)
        balance = booked(balance, clock, step.gas, step.heat + heat, step.net_flux)
        top = Top(step.front, top.front, step.eps, balance.released / mass)
        clock = tick(clock, ratio, exposure, numerics, t_end)
        record(
            trace[steps],
            clock.t,
            balance.released,
            step.rate,
            top.front,
            depth,
            work,
            first,
            probes,
        )
        if status == UNBURNT and is_burnt_out(work, first, network, BURNT_FRACTION * mass):
            status = OK
            if stop_when_burnt:
                break
    mass_error = abs(total_mass(work) + balance.released - mass) / mass
    return status, steps, energy_error(balance), mass_error


@entry
def slab(start, T_start, material, network, exposure, numerics, t_end, stop_when_burnt, probes):
    """Run one sample under one exposure.

    Parameters
    ----------
    start : initial masses of the cells [kg/m2], shape (cells, components), front first.
    T_start : initial temperature [K].
    material, network, exposure, numerics : see `pyrofit.solver.arrays`.
    t_end : end of the run [s].
    stop_when_burnt : end as soon as the reactant is gone.
    probes : Lagrangian positions (in cells) of temperature probes, shape (probes,).

    Returns
    -------
    status, steps, time, released, rate, front, back, thickness, probe temperatures, energy error
    (imbalance relative to the heat that crossed the surfaces), mass error (relative).
    """
    work = allocate(start, T_start, network.reactant.size)
    trace = np.empty((numerics.most_steps + 1, PROBES + probes.size))
    status, steps, energy_error, mass_error = march(
        start,
        T_start,
        material,
        network,
        exposure,
        numerics,
        t_end,
        stop_when_burnt,
        probes,
        work,
        trace,
    )
    trace = trace[: steps + 1]
    return (
        status,
        steps,
        trace[:, TIME].copy(),
        trace[:, RELEASED].copy(),
        trace[:, RATE].copy(),
        trace[:, FRONT].copy(),
        trace[:, BACK].copy(),
        trace[:, THICKNESS].copy(),
        trace[:, PROBES:].copy(),
        energy_error,
        mass_error,
    )
