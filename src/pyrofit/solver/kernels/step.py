"""One time step of the slab, from the state before to the state after it."""

import math
from typing import NamedTuple

from pyrofit.solver.arrays import Status
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.bdf import formula
from pyrofit.solver.kernels.cells import (
    correct_rate_constants,
    integrate_rate_constants,
    layer,
    log_mean,
    mass_loss_rate,
    properties,
    rate_constants,
    top_emissivity,
)
from pyrofit.solver.kernels.heat import (
    conduct,
    irradiation,
    lose_at_edge,
    net_flux,
    surface_heat,
    temperature_falls,
)
from pyrofit.solver.kernels.jit import inner, live, loop
from pyrofit.solver.kernels.reactions import react

TEMPERATURE_SCALE = 400.0
"""Surface temperature error [K] that counts as much as an error of the whole rate scale."""
COLDEST_K, HOTTEST_K = 50.0, 5000.0
"""Range that temperatures must not leave."""
OK, DIVERGED, NON_FINITE = int(Status.OK), int(Status.DIVERGED), int(Status.NON_FINITE)


class Top(NamedTuple):
    """What a step starts from, besides the cells."""

    front: float
    """Front temperature [K]."""
    front_old: float
    """The same a step before [K]."""
    eps: float
    """Front emissivity."""
    converted: float
    """Mass released over initial mass."""


class Step(NamedTuple):
    """What a step came to."""

    status: int
    """OK, DIVERGED or NON_FINITE."""
    error: float
    """Scaled difference of predictor and corrector."""
    front: float
    """Front temperature [K]."""
    eps: float
    """Front emissivity."""
    rate: float
    """Mass loss rate at the end [kg/(m2 s)]."""
    gas: float
    """Gas released [kg/m2]."""
    heat: float
    """Heat stored and used by reactions [J/m2]."""
    net_flux: float
    """Heat flux through both surfaces at the end [W/m2]."""


@inner
def extrapolate(cell, first, r):
    """Fill T*."""
    for n in live(cell, first):
        T = cell[row.T, n]
        cell[row.T_star, n] = T + r * (T - cell[row.T_old, n])


@inner
def linearise(work, first, bdf, network):
    """Fill the heat source -sum_j dh_j r_j of the cells as a line in T_new."""
    cell = work.cell
    for n in live(work.m, first):
        cell[row.slope, n] = 0.0
    for j in range(work.k.shape[0]):
        by_rate = network.heat[j] * network.activation_temperature[j]
        for n in live(work.m, first):
            cell[row.slope, n] += by_rate * work.growth[j, n] * work.left[j, n]
    for n in live(work.m, first):
        slope = bdf.b1 * cell[row.slope, n] * cell[row.inverse_T, n] * cell[row.inverse_T, n]
        used = bdf.b1 * cell[row.heat_new, n] - bdf.b3 * cell[row.heat, n]
        cell[row.slope, n] = slope
        cell[row.source, n] = slope * cell[row.T_star, n] - used


@inner
def used_heat(work, first, network):
    """Fill the reaction heat used in the step."""
    cell = work.cell
    for n in live(work.m, first):
        cell[row.heat_new, n] = 0.0
    for j in range(work.k.shape[0]):
        for n in live(work.m, first):
            cell[row.heat_new, n] += network.heat[j] * work.used[j, n]


@loop
def react_all(work, first, dt, network):
    """Fill masses and heat after the step that follow from its rates; return the MLR at its end."""
    integrate_rate_constants(work, first, dt)
    react(work.m, work.formed, first, work.x, network, False, work.m_new, work.used)
    used_heat(work, first, network)
    return mass_loss_rate(work, first, network)


@inner
def gas_released(work, first, network):
    """Return the gas released in the step [kg/m2]."""
    gas = 0.0
    for j in range(work.k.shape[0]):
        for n in live(work.m, first):
            gas += network.gas[j] * work.used[j, n]
    return gas


@inner
def heat_taken(work, first):
    """Return the heat stored in the step and used by its reactions [J/m2]."""
    cell = work.cell
    foil = work.m.shape[1]
    taken = cell[row.C_new, foil] * (cell[row.T_new, foil] - cell[row.T, foil])
    for n in live(work.m, first):
        C, _ = log_mean(cell[row.C, n], cell[row.C_new, n])
        taken += cell[row.heat_new, n] + C * (cell[row.T_new, n] - cell[row.T, n])
    return taken


@inner
def changed_emissivity(eps, top, work, first, mass, network, exposure):
    """Return the emissivity as it has changed with the mass released up to the end of the step."""
    if exposure.emissivity_change == 0.0:
        return eps
    converted = top.converted + gas_released(work, first, network) / mass
    return min(max(eps + exposure.emissivity_change * converted, 0.0), 1.0)


@inner
def advance(work, first, top, clock, mass, rate_scale, material, network, exposure):
    """Take one step; the state it starts from stays."""
    cell = work.cell
    bdf = formula(clock)
    extrapolate(cell, first, bdf.r)
    front_star = top.front + bdf.r * (top.front - top.front_old)
    temperature_falls(cell, first, front_star)
    rate_constants(work, first, network)

    predicted = react_all(work, first, bdf.dt, network)
    properties(work, first, material)

    linearise(work, first, bdf, network)
    t = clock.t + bdf.dt
    eps = top_emissivity(exposure.mixing_depth, work.skin, work.m_new, first, material, top.eps)
    seen = changed_emissivity(eps, top, work, first, mass, network, exposure)
    q = seen * irradiation(t, clock.piece, exposure)
    T_skin = 0.5 * (front_star + cell[row.T_star, first])
    _, r_skin, C_skin = layer(work.skin, 0, material, T_skin)
    surface = surface_heat(q, seen, front_star, t, r_skin, work, first, material, exposure)
    if exposure.edge_exchange != 0.0:
        lose_at_edge(work, first, exposure)
    cell[row.C_new, first] += C_skin
    front_new = conduct(cell, first, surface, r_skin, bdf)

    correct_rate_constants(work, first, network)
    rate = react_all(work, first, bdf.dt, network)

    error = abs(rate - predicted) / rate_scale
    error = max(error, abs(front_new - front_star) / TEMPERATURE_SCALE)
    foil_change = abs(cell[row.T_new, -1] - cell[row.T_star, -1])
    error = max(error, foil_change / TEMPERATURE_SCALE)
    return Step(
        status=check(cell, first, front_new, rate),
        error=error,
        front=front_new,
        eps=eps,
        rate=rate,
        gas=gas_released(work, first, network),
        heat=heat_taken(work, first),
        net_flux=net_flux(surface, front_new, work, first, exposure),
    )


@inner
def check(cell, first, front, rate):
    """Return whether the step can be used: OK, DIVERGED or NON_FINITE."""
    if not math.isfinite(front + cell[row.T_new, -1] + rate):
        return NON_FINITE
    coldest = front
    hottest = front
    for n in live(cell, first):
        coldest = min(coldest, cell[row.T_new, n])
        hottest = max(hottest, cell[row.T_new, n])
    return OK if coldest > COLDEST_K and hottest < HOTTEST_K else DIVERGED
