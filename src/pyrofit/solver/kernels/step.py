"""One time step of the slab, from the state before to the state after it."""

from typing import NamedTuple

from pyrofit.compiled.jit import between, inner, live, loop
from pyrofit.solver.arrays import LIT, Number, Status
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.bdf import formula
from pyrofit.solver.kernels.cells import (
    correct_rate_constants,
    describe,
    fill_rate_constants,
    layer,
    mean_capacity,
    react_over,
)
from pyrofit.solver.kernels.functions import fma
from pyrofit.solver.kernels.heat import (
    Front,
    above_gas,
    add_at_edge,
    at_edge,
    conduct,
    convection,
    heat_gas,
    irradiation,
    lose_at_edge,
    net_flux,
    surface_heat,
    temperature_falls,
)
from pyrofit.solver.kernels.lanes import somewhere, where
from pyrofit.solver.kernels.oxygen import (
    correct_in_depth,
    extrapolate_depths,
    fill_in_depth,
    is_short,
    measure_depths,
    open_up,
    share_supply,
)
from pyrofit.solver.kernels.radiation import top_emissivity
from pyrofit.solver.kernels.schedule import during, given_at

TEMPERATURE_SCALE = 400.0
"""Surface temperature error [K] that counts as much as an error of the whole rate scale."""
COLDEST_K, HOTTEST_K = 50.0, 5000.0
"""Range that temperatures must not leave."""
OK, DIVERGED, NON_FINITE = float(Status.OK), float(Status.DIVERGED), float(Status.NON_FINITE)


class Step(NamedTuple):
    """The result of a step."""

    status: Number
    """OK, DIVERGED or NON_FINITE."""
    error: Number
    """Scaled difference of predictor and corrector."""
    front: Number
    """Front temperature [K]."""
    eps: Number
    """Front emissivity."""
    rate: Number
    """Mass loss rate at the end [kg/(m2 s)]."""
    gas: Number
    """Gas released [kg/m2]."""
    burnt: Number
    """Heat of combustion of that where it burns [J/m2]; zero where it is not recorded."""
    power: Number
    """The same per time at the end [W/m2]."""
    heat: Number
    """Heat stored and used by reactions [J/m2]."""
    net_flux: Number
    """Heat flux through both surfaces at the end [W/m2]."""


@inner
def extrapolate(wide, first, r):
    """Fill T*."""
    cell = wide.cell
    for n in live(cell, first):
        T = cell[row.T, n]
        cell[row.T_star, n] = fma(r, T - cell[row.T_old, n], T)


@loop
def fill_rates(wide, first, network):
    """Fill the roots of all k_j at T*."""
    fill_rate_constants(wide, first, network)
    if network.oxidises:
        fill_in_depth(wide, first, network)


@loop
def predict(wide, first, bdf, room, description):
    """Fill the masses that rates at T* lead to, properties, and the heat source as a line in T."""
    cell, network = wide.cell, description.network
    react_over(wide, first, bdf.dt, room, network, False)
    describe(wide, first, description.material)
    for n in live(wide.m, first):
        inverse_T = cell[row.inverse_T, n]
        slope = bdf.b1 * cell[row.grows, n] * inverse_T * inverse_T
        used = fma(bdf.b1, cell[row.heat, n], -(bdf.b3 * cell[row.stored_old, n]))
        cell[row.slope, n] = slope
        cell[row.source, n] = fma(slope, cell[row.T_star, n], -used)
        cell[row.C_mean, n] = mean_capacity(cell, n)


@loop
def correct(wide, first, dt, room, network):
    """Fill rates at T_new, the masses they lead to, and the heat stored in the step."""
    cell = wide.cell
    correct_rate_constants(wide, first, network)
    if network.oxidises:
        correct_in_depth(wide, first, network)
    react_over(wide, first, dt, room, network, True)
    for n in live(wide.m, first):
        risen = cell[row.T_new, n] - cell[row.T, n]
        cell[row.stored, n] = fma(cell[row.C_mean, n], risen, cell[row.heat, n])


class Sums(NamedTuple):
    """Sums over the cells."""

    rate: Number
    gas: Number
    stored: Number


@inner
def summed_up(work, first):
    """Return the sums over the cells, one after the other: the same bits in any width."""
    cell = work.cell
    none = 0.0 * cell[row.rate, first]
    rate, gas, stored = none, none, none
    for n in live(work.m, first):
        rate += cell[row.rate, n]
        gas += cell[row.gas, n]
        stored += cell[row.stored, n]
    return Sums(rate, gas, stored)


@inner
def summed(work, what, first):
    """Return the sum of a row over the cells."""
    total = 0.0 * work.cell[what, first]
    for n in live(work.m, first):
        total += work.cell[what, n]
    return total


@inner
def first_wide(arrays, edge):
    """Return the first wide cell on the grid.

    Wide cells hold several of a set that runs alone; the empty ones among them do no harm.
    """
    return edge.first * arrays.wide.m.shape[1] // arrays.work.m.shape[1]


@inner
def changed_emissivity(eps, now, released, exposure):
    """Return the emissivity as it has changed with the mass released up to the end of the step."""
    change = exposure.emissivity_change
    changed = min(max(fma(change, now.top.converted + released / now.mass, eps), 0.0), 1.0)
    return where(change != 0.0, changed, eps)


@inner
def extrapolated(arrays, edge, now, bdf, description):
    """Fill T* and the quantities that follow from it; return T* of the front."""
    work, top = arrays.work, now.top
    block = first_wide(arrays, edge)
    extrapolate(arrays.wide, block, bdf.r)
    front_star = fma(bdf.r, top.front - top.front_old, top.front)
    temperature_falls(work.cell, work.m.shape[1], edge, front_star)
    if description.network.oxidises:
        open_up(work, now.clock.piece, description.exposure.schedule, description.network)
        extrapolate_depths(arrays.wide, block, bdf.r)
    fill_rates(arrays.wide, block, description.network)
    if description.network.oxidises and is_short(description.network):
        breathe(arrays, edge, now, front_star, bdf.dt, description)
    predict(arrays.wide, block, bdf, arrays.room, description)
    return front_star


@loop
def breathe(arrays, edge, now, front_star, dt, description):
    """Bring the rates of reactions that use up oxygen to the supply by convection.

    Their need at the end of the step follows from masses that a first pass leaves.
    """
    work, exposure, network = arrays.work, description.exposure, description.network
    piece, t = now.clock.piece, now.clock.t + dt
    air = given_at(t, piece, exposure.schedule).front
    h = convection(exposure.front, air, above_gas(exposure.front, air, front_star, t))
    share_supply(work, edge.first, work.m, h, piece, exposure.schedule, network)
    react_over(arrays.wide, first_wide(arrays, edge), dt, arrays.room, network, False)
    share_supply(work, edge.first, work.m_new, h, piece, exposure.schedule, network)


@inner
def exchanged(work, edge, now, front_star, t, description):
    """Fill the heat exchange of faces and edge; return the front's, r_skin and emissivity."""
    cell, first = work.cell, edge.first
    material, network, exposure = description
    eps = top_emissivity(exposure.mixing_depth, work.skin, work.m_new, first, material, now.top.eps)
    seen = eps
    if somewhere(exposure.emissivity_change != 0.0):
        seen = changed_emissivity(eps, now, released(work, first, network), exposure)
    given = given_at(t, now.clock.piece, exposure.schedule)
    q = seen * irradiation(given, t, exposure)
    T_skin = 0.5 * (front_star + at_edge(cell, row.T_star, edge))
    _, r_skin, C_skin = layer(work.skin, 0, material, T_skin)
    surface = surface_heat(q, seen, front_star, t, given, r_skin, work, edge, material, exposure)
    if somewhere(exposure.edge_exchange != 0.0):
        lose_at_edge(work, first, exposure)
    if somewhere(exposure.gas_heat != 0.0):
        taken = heat_gas(work, edge, work.m.shape[1], exposure)
        surface = Front(surface.gain, surface.slope, surface.inside - taken)
    add_at_edge(cell, row.C_new, edge, C_skin)
    for n in between(edge.first, edge.behind):
        cell[row.C_mean, n] = mean_capacity(cell, n)
    return surface, r_skin, eps


@inner
def burning(work, first, piece, description):
    """Return the heat of combustion [J/m2] and that per time [W/m2], zero if not recorded."""
    burnt, power = 0.0 * work.cell[row.rate, first], 0.0 * work.cell[row.rate, first]
    if description.network.burns:
        burnt, power = summed(work, row.burnt, first), summed(work, row.power, first)
        if not description.network.oxidises:
            lit = during(piece, LIT, description.exposure.schedule)
            burnt, power = lit * burnt, lit * power
    return burnt, power


@inner
def scaled_error(work, rate_off, front_off):
    """Return the largest of the errors of rate (scaled) and of front and back temperature."""
    cell, foil = work.cell, work.m.shape[1]
    error = max(abs(rate_off), abs(front_off) / TEMPERATURE_SCALE)
    return max(error, abs(cell[row.T_new, foil] - cell[row.T_star, foil]) / TEMPERATURE_SCALE)


@inner
def advance(arrays, edge, now, description):
    """Take one step; the state it starts from stays."""
    work, first = arrays.work, edge.first
    cell, foil = work.cell, work.m.shape[1]
    bdf = formula(now.clock)
    front_star = extrapolated(arrays, edge, now, bdf, description)
    t = now.clock.t + bdf.dt
    surface, r_skin, eps = exchanged(work, edge, now, front_star, t, description)
    solved = conduct(cell, foil, edge, surface, r_skin, bdf)
    front = solved.front
    if description.network.oxidises:
        skin, _, _ = layer(work.skin, 0, description.material, front)
        measure_depths(work, first, skin)
    correct(arrays.wide, first_wide(arrays, edge), bdf.dt, arrays.room, description.network)
    sums = summed_up(work, first)
    in_foil = cell[row.C_mean, foil] * (cell[row.T_new, foil] - cell[row.T, foil])
    cell[row.stored, foil] = in_foil
    burnt, power = burning(work, first, now.clock.piece, description)
    return Step(
        status=check(solved, cell[row.T_new, foil], sums.rate),
        error=scaled_error(work, (sums.rate - solved.rate) / now.rate_scale, front - front_star),
        front=front,
        eps=eps,
        rate=sums.rate,
        gas=sums.gas,
        burnt=burnt,
        power=power,
        heat=sums.stored + in_foil,
        net_flux=net_flux(surface, front, work, first, description.exposure),
    )


@inner
def released(work, first, network):
    """Return the gas that the masses predicted for the end of the step have released [kg/m2]."""
    gas = 0.0 * work.m[0, first]
    for n in live(work.m, first):
        for i in range(work.m.shape[0]):
            gas += work.m[i, n] - work.m_new[i, n]
    return gas


@inner
def check(solved, back, rate):
    """Return whether the step can be used: OK, DIVERGED or NON_FINITE."""
    total = solved.front + back + rate
    within = (solved.coldest > COLDEST_K) & (solved.hottest < HOTTEST_K)
    return where(total - total == 0.0, where(within, OK, DIVERGED), NON_FINITE)
