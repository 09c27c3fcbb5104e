"""Heat exchange of the surfaces and conduction through the cells."""

import math
from typing import NamedTuple

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.cells import optical_depth
from pyrofit.solver.kernels.jit import inner, live

SIGMA = STEFAN_BOLTZMANN


class Front(NamedTuple):
    """Heat that enters through the front: gain - slope * T_new, and inside the cells [W/m2]."""

    gain: float
    slope: float
    inside: float
    """Radiation that does not stop at the surface, less what leaves at the back."""


@inner
def flux_piece(t, time):
    """Return the piece of the flux table in which the time after t lies."""
    p = 0
    while p + 1 < time.size and time[p + 1] <= t:
        p += 1
    return p


@inner
def flux_at(t, p, time, flux):
    """Return q_ext(t) on piece p of the flux table."""
    if p >= time.size - 1:
        return flux[time.size - 1]
    if t <= time[p]:
        return flux[p]
    return flux[p] + (flux[p + 1] - flux[p]) * (t - time[p]) / (time[p + 1] - time[p])


@inner
def approach(t, time):
    """Return 1 - exp(-t/time), what is reached of a value approached with a time constant."""
    return 1.0 - math.exp(-t / time) if time > 0.0 else 1.0


@inner
def irradiation(t, piece, exposure):
    """Return q_ext(t): the table's, times the heater's coming up and its drift."""
    flux = flux_at(t, piece, exposure.flux_time, exposure.flux)
    drifted = t
    if exposure.drift_time > 0.0:
        drifted = exposure.drift_time * approach(t, exposure.drift_time)
    return flux * approach(t, exposure.rise_time) * max(1.0 + exposure.drift * drifted, 0.0)


@inner
def exchange(surface, emissivity, T, t):
    """Linearise the loss of a surface about T: net gain = gain - slope * T_new [W/m2]."""
    dT = T - surface.gas_temperature - surface.gas_rise * approach(t, surface.gas_rise_time)
    h = surface.h
    if surface.h_cube_root != 0.0:
        h += surface.h_cube_root * abs(dT) ** (1.0 / 3.0)
    cube = T * T * T
    slope = 4.0 * emissivity * SIGMA * cube + h
    wall = surface.wall_temperature
    gain = emissivity * SIGMA * (wall * wall * wall * wall - cube * T) - h * dT + slope * T
    return gain, slope


@inner
def is_opaque(material):
    """Tell whether all components absorb at the surface."""
    opaque = True
    for i in range(material.absorption.size):
        opaque = opaque and material.absorption[i] <= 0.0
    return opaque


@inner
def mean_depth(optical):
    """Return the mean depth at which a layer absorbs over its thickness, 1/tau - 1/(e^tau - 1)."""
    if optical < 1e-2:
        return 0.5 - optical / 12.0
    return 1.0 / optical - 1.0 / math.expm1(min(optical, 700.0))


@inner
def absorb(radiation, r_skin, work, first, material):
    """Add the radiation that each cell absorbs to its source.

    Return what passes through all, and what acts at the front. What skin and first half cell
    absorb acts at the front and at the first cell's centre as its resistance to these tells.
    """
    cell = work.cell
    half = cell[row.half_r, first]
    skin = optical_depth(work.skin, 0, material)
    passing = radiation * math.exp(-skin)
    at_front = (radiation - passing) * (1.0 - mean_depth(skin) * r_skin / (r_skin + half))
    cell[row.source, first] += radiation - passing - at_front
    for n in live(work.m, first):
        optical = optical_depth(work.m_new, n, material)
        passed = passing * math.exp(-optical)
        forward = 0.0
        if n == first:
            share = half * (1.0 - 2.0 * mean_depth(optical)) / (r_skin + half)
            forward = share * (passing - passed)
            at_front += forward
        cell[row.source, n] += passing - passed - forward
        passing = passed
    return passing, at_front


@inner
def lose_at_edge(work, first, exposure):
    """Add to every cell what its edge exchanges with the gas beside it."""
    cell = work.cell
    for n in live(work.m, first):
        loss = exposure.edge_exchange * cell[row.d, n]
        cell[row.slope, n] += loss
        cell[row.source, n] += loss * exposure.edge_temperature


@inner
def surface_heat(radiation, eps, front_star, t, r_skin, work, first, material, exposure):
    """Fill the heat source of the foil and return that of the front, about T*."""
    cell = work.cell
    foil = work.m.shape[1]
    gain, slope = exchange(exposure.front, eps, front_star, t)
    gain_back, slope_back = exchange(
        exposure.back, exposure.back_emissivity, cell[row.T_star, foil], t
    )
    inside = 0.0
    if is_opaque(material):
        gain += radiation
    else:
        transmitted, at_front = absorb(radiation, r_skin, work, first, material)
        gain += at_front
        inside = radiation - at_front - transmitted
        if exposure.foil_opaque:
            gain_back += transmitted
    cell[row.source, foil] = gain_back
    cell[row.slope, foil] = slope_back
    return Front(gain, slope, inside)


@inner
def net_flux(surface, front, work, first, exposure):
    """Return the heat that enters through surfaces and edge at the end of the step [W/m2]."""
    cell = work.cell
    foil = work.m.shape[1]
    flux = cell[row.source, foil] - cell[row.slope, foil] * cell[row.T_new, foil]
    if exposure.edge_exchange != 0.0:
        for n in live(work.m, first):
            loss = exposure.edge_exchange * cell[row.d, n]
            flux += loss * (exposure.edge_temperature - cell[row.T_new, n])
    return surface.gain - surface.slope * front + surface.inside + flux


@inner
def temperature_falls(cell, first, front_star):
    """Fill half the temperature difference across each cell [K]."""
    last = cell.shape[1] - 2
    # Before the foil the resistance of the contact counts as solid, of thickness k R.
    cell[row.d, last + 1] = cell[row.d, last] * cell[row.half_r, last + 1] / cell[row.half_r, last]
    for n in range(first + 1, last + 1):
        d = cell[row.d, n]
        span = 0.5 * (cell[row.d, n - 1] + cell[row.d, n + 1]) + d
        across = cell[row.T_star, n - 1] - cell[row.T_star, n + 1]
        cell[row.fall, n] = 0.5 * across * d / span if span > 0.0 else 0.0
    cell[row.fall, first] = front_star - cell[row.T_star, first]


@inner
def conduct(cell, first, surface, r_skin, bdf):
    """Solve C dT/dt = conduction + source for T_new; return the front temperature.

    Elimination from the front: ``seen`` is the conductance to the surroundings through all that
    lies above a row, ``carried`` the heat that comes that way.
    """
    foil = cell.shape[1] - 1
    lead = r_skin + cell[row.half_r, first]
    couple = 1.0 / (1.0 + surface.slope * lead)
    seen = surface.slope * couple
    carried = surface.gain * couple
    for n in range(first, foil + 1):
        C = cell[row.C_new, n]
        below = 1.0 / (cell[row.half_r, n] + cell[row.half_r, n + 1]) if n < foil else 0.0
        own = C * bdf.b1 + cell[row.slope, n] + seen
        stored = C * (bdf.b2 * cell[row.T, n] - bdf.b3 * cell[row.T_old, n])
        inverse = 1.0 / (own + below)
        upper = below * inverse
        heat = stored + cell[row.source, n] + carried
        cell[row.right, n] = heat * inverse
        cell[row.upper, n] = upper
        seen = own * upper
        carried = heat * upper
    T = 0.0
    for n in range(foil, first - 1, -1):
        T = cell[row.right, n] + cell[row.upper, n] * T
        cell[row.T_new, n] = T
    return (surface.gain * lead + T) * couple
