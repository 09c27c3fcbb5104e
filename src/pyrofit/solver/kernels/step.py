"""One time step of the slab, from the state before to the state after it."""

from typing import NamedTuple

from pyrofit.solver.arrays import LIT, Number, Status
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.bdf import formula
from pyrofit.solver.kernels.cells import (
    correct_rate_constants,
    describe,
    layer,
    rate_constants,
    react_over,
    top_emissivity,
)
from pyrofit.solver.kernels.functions import fma, nearly_inverse
from pyrofit.solver.kernels.heat import (
    Front,
    add_at_edge,
    at_edge,
    conduct,
    heat_gas,
    irradiation,
    lose_at_edge,
    net_flux,
    surface_heat,
    temperature_falls,
)
from pyrofit.solver.kernels.jit import between, inner, live, loop
from pyrofit.solver.kernels.lanes import somewhere, where
from pyrofit.solver.kernels.reactions import TINY
from pyrofit.solver.kernels.schedule import during, given_at

TEMPERATURE_SCALE = 400.0
"""Surface temperature error [K] that counts as much as an error of the whole rate scale."""
COLDEST_K, HOTTEST_K = 50.0, 5000.0
"""Range that temperatures must not leave."""
OK, DIVERGED, NON_FINITE = float(Status.OK), float(Status.DIVERGED), float(Status.NON_FINITE)


class Top(NamedTuple):
    """What a step starts from, besides the cells."""

    front: Number
    """Front temperature [K]."""
    front_old: Number
    """The same a step before [K]."""
    eps: Number
    """Front emissivity."""
    converted: Number
    """Mass released over initial mass."""


class Step(NamedTuple):
    """What a step came to."""

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
def predict(wide, first, bdf, room, material, network):
    """Fill rates at T*, the masses they lead to, properties, and the heat source as a line in T."""
    cell = wide.cell
    rate_constants(wide, first, network)
    react_over(wide, first, bdf.dt, room, network, False)
    describe(wide, first, material)
    for n in live(wide.m, first):
        slope = bdf.b1 * cell[row.grows, n] * cell[row.inverse_T, n] * cell[row.inverse_T, n]
        used = bdf.b1 * cell[row.heat, n] - bdf.b3 * cell[row.stored_old, n]
        cell[row.slope, n] = slope
        cell[row.source, n] = fma(slope, cell[row.T_star, n], -used)
        cell[row.C_mean, n] = mean_capacity(cell, n)


@loop
def correct(wide, first, dt, room, network):
    """Fill rates at T_new, the masses they lead to, and the heat stored in the step."""
    cell = wide.cell
    correct_rate_constants(wide, first, network)
    react_over(wide, first, dt, room, network, True)
    for n in live(wide.m, first):
        risen = cell[row.T_new, n] - cell[row.T, n]
        cell[row.stored, n] = fma(cell[row.C_mean, n], risen, cell[row.heat, n])


@inner
def mean_capacity(cell, n):
    """Return the mean of C over the step: logarithmic, and more where gas is released ever faster.

    The cubic with the ends C and C_new, and slopes in proportion to the rates r there, has the mean
    (C + C_new)/2 + (C - C_new) (r_new - r)/(6 (r_new + r)). What is returned is that to first order
    in r_new/r, and the logarithmic mean m (1 - d^2/3 - 4 d^4/45), d = (C_new - C)/(C_new + C),
    where C falls exponentially: r_new/r is C_new/C. C that changes with temperature leaves it.
    """
    C, C_new = cell[row.C, n], cell[row.C_new, n]
    both = max(C + C_new, TINY)
    d = (C_new - C) * nearly_inverse(both)
    d2 = d * d
    mean = 0.5 * both * fma(d2, fma(d2, -4.0 / 45.0, -1.0 / 3.0), 1.0)
    before, after = cell[row.rate_old, n] * C_new, cell[row.rate, n] * C
    faster = (after - before) * nearly_inverse(max(abs(after) + abs(before), TINY))
    return fma((1.0 / 6.0) * cell[row.C_lost, n], faster, mean)


@inner
def summed(work, what, first):
    """Return the sum of a row over the cells."""
    total = 0.0 * work.cell[what, first]
    for n in live(work.m, first):
        total += work.cell[what, n]
    return total


@inner
def changed_emissivity(eps, top, released, mass, exposure):
    """Return the emissivity as it has changed with the mass released up to the end of the step."""
    change = exposure.emissivity_change
    changed = min(max(fma(change, top.converted + released / mass, eps), 0.0), 1.0)
    return where(change != 0.0, changed, eps)


@inner
def advance(work, wide, edge, top, clock, mass, rate_scale, room, material, network, exposure):
    """Take one step; the state it starts from stays."""
    cell = work.cell
    first = edge.first
    # Wide cells hold several of a set that runs alone; the empty ones among them do no harm.
    block = first * wide.m.shape[1] // work.m.shape[1]
    foil = work.m.shape[1]
    bdf = formula(clock)
    extrapolate(wide, block, bdf.r)
    front_star = fma(bdf.r, top.front - top.front_old, top.front)
    temperature_falls(cell, foil, edge, front_star)
    predict(wide, block, bdf, room, material, network)

    t = clock.t + bdf.dt
    eps = top_emissivity(exposure.mixing_depth, work.skin, work.m_new, first, material, top.eps)
    seen = eps
    if somewhere(exposure.emissivity_change != 0.0):
        seen = changed_emissivity(eps, top, released(work, first, network), mass, exposure)
    given = given_at(t, clock.piece, exposure.schedule)
    q = seen * irradiation(given, t, exposure)
    T_skin = 0.5 * (front_star + at_edge(cell, row.T_star, edge))
    _, r_skin, C_skin = layer(work.skin, 0, material, T_skin)
    surface = surface_heat(q, seen, front_star, t, given, r_skin, work, edge, material, exposure)
    if somewhere(exposure.edge_exchange != 0.0):
        lose_at_edge(work, first, exposure)
    if somewhere(exposure.gas_heat != 0.0):
        taken = heat_gas(work, edge, foil, exposure)
        surface = Front(surface.gain, surface.slope, surface.inside - taken)
    add_at_edge(cell, row.C_new, edge, C_skin)
    for n in between(edge.first, edge.behind):
        cell[row.C_mean, n] = mean_capacity(cell, n)
    predicted = summed(work, row.rate, first)
    front_new = conduct(cell, foil, edge, surface, r_skin, bdf)

    correct(wide, block, bdf.dt, room, network)
    rate = summed(work, row.rate, first)
    in_foil = cell[row.C_mean, foil] * (cell[row.T_new, foil] - cell[row.T, foil])
    cell[row.stored, foil] = in_foil

    burnt, power = 0.0 * rate, 0.0 * rate
    if network.burns:
        lit = during(clock.piece, LIT, exposure.schedule)
        burnt = lit * summed(work, row.burnt, first)
        power = lit * summed(work, row.power, first)

    error = abs(rate - predicted) / rate_scale
    error = max(error, abs(front_new - front_star) / TEMPERATURE_SCALE)
    foil_change = abs(cell[row.T_new, foil] - cell[row.T_star, foil])
    error = max(error, foil_change / TEMPERATURE_SCALE)
    return Step(
        status=check(cell, foil, first, front_new, rate),
        error=error,
        front=front_new,
        eps=eps,
        rate=rate,
        gas=summed(work, row.gas, first),
        burnt=burnt,
        power=power,
        heat=summed(work, row.stored, first) + in_foil,
        net_flux=net_flux(surface, front_new, work, first, exposure),
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
def check(cell, foil, first, front, rate):
    """Return whether the step can be used: OK, DIVERGED or NON_FINITE."""
    total = front + cell[row.T_new, foil] + rate
    coldest = front
    hottest = front
    for n in between(first, foil + 1):
        coldest = min(coldest, cell[row.T_new, n])
        hottest = max(hottest, cell[row.T_new, n])
    within = (coldest > COLDEST_K) & (hottest < HOTTEST_K)
    return where(total - total == 0.0, where(within, OK, DIVERGED), NON_FINITE)
