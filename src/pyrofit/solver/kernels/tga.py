"""Thermogravimetric analysis: masses along prescribed temperatures."""

import math
from typing import Any, NamedTuple

import numpy as np

from pyrofit.solver.kernels.functions import exp, power
from pyrofit.solver.kernels.jit import entry, inner, loop
from pyrofit.solver.kernels.lanes import in_lanes, somewhere, where
from pyrofit.solver.kernels.reactions import TINY, decay, react
from pyrofit.solver.kernels.views import network_in_lanes
from pyrofit.solver.kernels.work import make_room


class Parts(NamedTuple):
    """What the heats of one program are made of: whether they are wanted, and where they go."""

    detailed: Any
    burns: Any
    burning: Any
    response: Any
    masses: Any
    rates: Any
    release: Any


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
def _note_parts(n, m, formed, k, network, heats):
    """Write the masses of the components and the rates of the reactions at point n."""
    if heats.detailed:
        for i in range(m.shape[0]):
            heats.masses[n, i] = m[i, 0]
        for j in range(k.size):
            heats.rates[n, j] = _rate(m, formed, k, network, j)


@loop
def _heat(
    time, temperature, lag, network, longest_rise, m, m_new, formed, room, k, mass, rate, heats
):
    """Follow one program; the arrays are the state at its start, and room to work."""
    for j in range(k.size):
        k[j] = _arrhenius(network, j, temperature[0] - lag)
    mass[0] = _mass(m)
    rate[0] = _sum(network.gas, m, formed, k, network)
    _note_parts(0, m, formed, k, network, heats)
    burnt = 0.0 * m[0, 0]
    if heats.burns:
        burnt = _sum(heats.burning, m, formed, k, network)
        heats.release[0] = burnt
    seen = burnt
    for n in range(1, time.size):
        rise = temperature[n] - temperature[n - 1]
        parts = max(1, math.ceil(abs(rise) / longest_rise))
        dt = (time[n] - time[n - 1]) / parts
        for s in range(parts):
            here = temperature[n - 1] + rise * s / parts
            there = temperature[n - 1] + rise * (s + 1) / parts
            for j in range(k.size):
                k_new = _arrhenius(network, j, there - lag)
                middle = _arrhenius(network, j, 0.5 * (here + there) - lag)
                room.x[j] = dt * (k[j] + 4.0 * middle + k_new) / 6.0
                k[j] = k_new
            react(m, formed, 0, room, network, True, m_new)
            for j in range(k.size):
                for i in range(m.shape[0]):
                    formed[i, 0] += network.yields[j, i] * room.used[j]
            for i in range(m.shape[0]):
                m[i, 0] = m_new[i, 0]
            if heats.burns:
                mean = 0.0 * m[0, 0]
                for j in range(k.size):
                    mean += heats.burning[j] * room.used[j]
                before = burnt
                burnt = _sum(heats.burning, m, formed, k, network)
                seen = _followed(seen, mean / dt, before, burnt, dt, heats.response)
        mass[n] = _mass(m)
        rate[n] = _sum(network.gas, m, formed, k, network)
        _note_parts(n, m, formed, k, network, heats)
        if heats.burns:
            heats.release[n] = seen


@entry
def tga(width, time, temperature, begins, lag, start, network, longest_rise, wanted, heat):
    """Return the mass fraction, its rate of loss [1/s], and what heats are made of.

    dm_i/dt as in `react`; T(t) is linear between the points, the integral of each k_j over a
    substep of at most ``longest_rise`` [K] is Simpson's. The heat release follows that of the gas
    with the response time tau, tau dy/dt = sum_j h_j r_j - y.

    Parameters
    ----------
    width : a tuple with one entry per lane; its length is part of the compiled code.
    time, temperature : the programs, one behind the other [s], [K], shape (points,).
    begins : where each begins, and where the last one ends, shape (programs + 1,).
    lag : by which the sample is behind the program [K], shape (programs, lanes).
    start : mass fractions of the components, shape (components, lanes).
    network : see `pyrofit.solver.arrays`.
    wanted : whether masses and rates are wanted, and the heat release, shape (programs, 2).
    heat : h_j [J per kg of reactant], shape (reactions, lanes), and tau [s], (programs, lanes).

    Returns
    -------
    mass, rate, shape (points, lanes); by component and by reaction the same, shape
    (points, components, lanes) and (points, reactions, lanes); heat release [W per kg], shape
    (points, lanes). The last three have no points where no program wants them.
    """
    lanes = len(width)
    components, reactions = start.shape[0], network.reactant.size
    burning, response = heat
    points = time.size if wanted.any() else 0
    mass = np.empty((time.size, lanes))
    rate = np.empty((time.size, lanes))
    by_component = np.empty((points, components, lanes))
    by_reaction = np.empty((points, reactions, lanes))
    release = np.empty((points, lanes))
    masses = np.empty((3, components, 1, lanes))
    rates = np.empty((reactions, lanes))
    in_mass, in_rate = in_lanes(width, mass), in_lanes(width, rate)
    in_components, in_reactions = in_lanes(width, by_component), in_lanes(width, by_reaction)
    in_release = in_lanes(width, release)
    in_masses, k = in_lanes(width, masses), in_lanes(width, rates)
    room = make_room(width, reactions)
    reacting = network_in_lanes(width, None, network)
    for p in range(begins.size - 1):
        masses[0, :, 0, :] = start
        masses[2, :, 0, :] = start
        here = slice(begins[p], begins[p + 1])
        heats = Parts(
            wanted[p, 0],
            wanted[p, 1],
            in_lanes(width, burning),
            in_lanes(width, response[p]),
            in_components[here],
            in_reactions[here],
            in_release[here],
        )
        _heat(
            time[here],
            temperature[here],
            in_lanes(width, lag[p]),
            reacting,
            longest_rise,
            in_masses[0],
            in_masses[1],
            in_masses[2],
            room,
            k,
            in_mass[here],
            in_rate[here],
            heats,
        )
    return mass, rate, by_component, by_reaction, release
