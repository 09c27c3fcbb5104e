"""Thermogravimetric analysis: masses along prescribed temperatures."""

import math

import numpy as np

from pyrofit.solver.kernels.functions import exp, power
from pyrofit.solver.kernels.jit import entry, inner, loop
from pyrofit.solver.kernels.lanes import in_lanes, somewhere, where
from pyrofit.solver.kernels.reactions import TINY, react
from pyrofit.solver.kernels.views import network_in_lanes
from pyrofit.solver.kernels.work import make_room


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
def _loss(m, formed, k, network):
    loss = 0.0 * m[0, 0]
    for j in range(k.size):
        i = network.reactant[j]
        r = k[j] * m[i, 0]
        higher = network.order[j] - 1.0
        if somewhere(higher != 0.0):
            u = where(m[i, 0] > 0.0, m[i, 0] / max(formed[i, 0], TINY), 1.0)
            r = r * where(higher == 0.0, 1.0, power(u, higher))
        loss += network.gas[j] * r
    return loss


@loop
def _heat(time, temperature, lag, network, longest_rise, m, m_new, formed, room, k, mass, rate):
    """Follow one program; the arrays are the state at its start, and room to work."""
    for j in range(k.size):
        k[j] = _arrhenius(network, j, temperature[0] - lag)
    mass[0] = _mass(m)
    rate[0] = _loss(m, formed, k, network)
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
        mass[n] = _mass(m)
        rate[n] = _loss(m, formed, k, network)


@entry
def tga(width, time, temperature, begins, lag, start, network, longest_rise):
    """Return the mass fraction and its rate of loss [1/s] at the given times.

    dm_i/dt as in `react`; T(t) is linear between the points, the integral of each k_j over a
    substep of at most ``longest_rise`` [K] is Simpson's.

    Parameters
    ----------
    width : a tuple with one entry per lane; its length is part of the compiled code.
    time, temperature : the programs, one behind the other [s], [K], shape (points,).
    begins : where each begins, and where the last one ends, shape (programs + 1,).
    lag : by which the sample is behind the program [K], shape (programs, lanes).
    start : mass fractions of the components, shape (components, lanes).
    network : see `pyrofit.solver.arrays`.

    Returns
    -------
    mass, rate, shape (points, lanes).
    """
    lanes = len(width)
    components, reactions = start.shape[0], network.reactant.size
    mass = np.empty((time.size, lanes))
    rate = np.empty((time.size, lanes))
    masses = np.empty((3, components, 1, lanes))
    rates = np.empty((reactions, lanes))
    in_mass, in_rate = in_lanes(width, mass), in_lanes(width, rate)
    in_masses, k = in_lanes(width, masses), in_lanes(width, rates)
    room = make_room(width, reactions)
    reacting = network_in_lanes(width, None, network)
    for p in range(begins.size - 1):
        masses[0, :, 0, :] = start
        masses[2, :, 0, :] = start
        here = slice(begins[p], begins[p + 1])
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
        )
    return mass, rate
