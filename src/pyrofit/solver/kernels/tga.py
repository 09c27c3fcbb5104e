"""Thermogravimetric analysis: masses along prescribed temperatures."""

import math

import numpy as np

from pyrofit.compiled.jit import entry, inner, loop
from pyrofit.solver.kernels.functions import exp, power
from pyrofit.solver.kernels.heated import Gas, Program, allocate, of_points, sample_of
from pyrofit.solver.kernels.lanes import in_lanes, somewhere, where
from pyrofit.solver.kernels.reactions import TINY, decay, quickening, react
from pyrofit.solver.kernels.views import network_in_lanes


@inner
def _arrhenius(network, j, temperature):
    return (
        network.root_factor[j]
        * network.root_factor[j]
        * exp(-network.activation_temperature[j] / temperature)
    )


@inner
def _mass(m):
    mass = 0.0 * m[0, 0]
    for i in range(m.shape[0]):
        mass += m[i, 0]
    return mass


@inner
def _rate(m, formed, k, network, j):
    i = network.reactant[j]
    r = k[j] * m[i, 0]
    higher = network.order[j] - 1.0
    if somewhere(higher != 0.0):
        u = where(m[i, 0] > 0.0, m[i, 0] / max(formed[i, 0], TINY), 1.0)
        r = r * where(higher == 0.0, 1.0, power(u, higher))
    if network.catalysed:
        r = r * quickening(m[i, 0] / max(formed[i, 0], TINY), j, network)
    return r


@inner
def _sum(weights, m, formed, k, network):
    """Return the sum of the reaction rates, each with its weight."""
    total = 0.0 * m[0, 0]
    for j in range(k.size):
        total += weights[j] * _rate(m, formed, k, network, j)
    return total


@inner
def _followed(y, mean, x, x_new, dt, tau):
    """Return y after a step of tau dy/dt = x - y, and x itself where tau is zero.

    x is taken as linear with the slope of its ends and the given mean, so that no heat is lost:
    y E + mean (1 - E) + (x_new - x) (1 - phi - (1 - E)/2), E = exp(-h), phi = (1 - E)/h,
    h = dt/tau.
    """
    e, phi = decay(dt / max(tau, TINY), True)
    bend = (1.0 - phi) - 0.5 * (1.0 - e)
    return where(tau > 0.0, y * e + mean * (1.0 - e) + (x_new - x) * bend, x_new)


@inner
def _note(n, sample, network, gas, seen, written):
    """Write the wanted quantities of the sample at point n; ``seen`` is its heat release."""
    m, formed, k = sample.m, sample.formed, sample.k
    written.mass[n] = _mass(m)
    written.rate[n] = _sum(network.gas, m, formed, k, network)
    if gas.detailed:
        for i in range(m.shape[0]):
            written.masses[n, i] = m[i, 0]
        for j in range(k.size):
            written.rates[n, j] = _rate(m, formed, k, network, j)
    if gas.burns:
        written.release[n] = seen


@inner
def _react(sample, here, there, lag, dt, network):
    """Bring the sample over a substep; the programme goes from ``here`` to ``there`` [K]."""
    m, formed, k, room = sample.m, sample.formed, sample.k, sample.room
    for j in range(k.size):
        k_new = _arrhenius(network, j, there - lag)
        middle = _arrhenius(network, j, 0.5 * (here + there) - lag)
        room.x[j] = dt * (k[j] + 4.0 * middle + k_new) / 6.0
        k[j] = k_new
    react(m, formed, 0, room, network, True, sample.m_new)
    for j in range(k.size):
        for i in range(m.shape[0]):
            formed[i, 0] += network.yields[j, i] * room.used[j]
    for i in range(m.shape[0]):
        m[i, 0] = sample.m_new[i, 0]


@inner
def _burning(sample, network, gas):
    """Return the heat that burning releases [W per kg], zero where it is not wanted."""
    if gas.burns:
        return _sum(gas.heat, sample.m, sample.formed, sample.k, network)
    return 0.0 * sample.m[0, 0]


@inner
def _recorded(seen, before, burnt, dt, sample, gas):
    """Return the record of the heat release after a substep, from its record before."""
    if gas.burns:
        mean = 0.0 * burnt
        for j in range(sample.k.size):
            mean += gas.heat[j] * sample.room.used[j]
        return _followed(seen, mean / dt, before, burnt, dt, gas.response)
    return seen


@loop
def _heat(program, longest_rise, network, sample, gas, written):
    """Follow one program; the sample is in its initial state."""
    time, temperature, lag = program
    for j in range(sample.k.size):
        sample.k[j] = _arrhenius(network, j, temperature[0] - lag)
    burnt = _burning(sample, network, gas)
    seen = burnt
    _note(0, sample, network, gas, seen, written)
    for n in range(1, time.size):
        rise = temperature[n] - temperature[n - 1]
        parts = max(1, math.ceil(abs(rise) / longest_rise))
        dt = (time[n] - time[n - 1]) / parts
        for s in range(parts):
            here = temperature[n - 1] + rise * s / parts
            there = temperature[n - 1] + rise * (s + 1) / parts
            _react(sample, here, there, lag, dt, network)
            before = burnt
            burnt = _burning(sample, network, gas)
            seen = _recorded(seen, before, burnt, dt, sample, gas)
        _note(n, sample, network, gas, seen, written)


@entry
def tga(width, programs, lag, start, network, longest_rise, burning):
    """Return mass fraction, its rate of loss [1/s], the parts of the heat flow, and heat release.

    dm_i/dt as in `react`; T(t) is linear between the points, the integral of each k_j over a
    substep of at most ``longest_rise`` [K] is Simpson's. The heat release follows that of the gas
    with the response time tau, tau dy/dt = sum_j h_j r_j - y.

    Parameters
    ----------
    width : a tuple with one entry per lane; its length is part of the compiled code.
    programs : see `pyrofit.solver.run_heated.Programs`.
    lag : by which the sample is behind the program [K], shape (programs, lanes).
    start : mass fractions of the components, shape (components, lanes).
    network : see `pyrofit.solver.arrays`.
    burning : h_j [J per kg of reactant], shape (reactions, lanes), and tau [s], (programs, lanes).

    Returns
    -------
    mass, rate, shape (points, lanes). By component and by reaction the same, shape
    (points, components, lanes) and (points, reactions, lanes). Heat release [W per kg], shape
    (points, lanes). The last three have no points where no program wants them.
    """
    components, reactions, points = start.shape[0], network.reactant.size, programs.time_s.size
    detailed = points if programs.wanted.any() else 0
    written = allocate(len(width), components, reactions, points, detailed)
    masses = np.empty((3, components, 1, len(width)))
    sample = sample_of(width, masses, np.empty((reactions, len(width))))
    reacting = network_in_lanes(width, None, network)
    for p in range(programs.begins.size - 1):
        masses[0, :, 0, :] = start
        masses[2, :, 0, :] = start
        part = slice(programs.begins[p], programs.begins[p + 1])
        lags, wanted = in_lanes(width, lag[p]), programs.wanted[p]
        heat, response = in_lanes(width, burning[0]), in_lanes(width, burning[1][p])
        _heat(
            Program(programs.time_s[part], programs.temperature_K[part], lags),
            longest_rise,
            reacting,
            sample,
            Gas(wanted[0], wanted[1], heat, response),
            of_points(width, written, part),
        )
    return written
