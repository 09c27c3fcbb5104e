"""Thermogravimetric analysis: masses along a prescribed temperature."""

import math

import numpy as np

from pyrofit.solver.kernels.jit import entry
from pyrofit.solver.kernels.reactions import react


@entry
def tga(time, temperature, start, network, longest_rise):
    """Return the mass fraction and its rate of loss [1/s] at the given times.

    dm_i/dt as in `react`; T(t) is linear between the points (shape (points,), [s] and [K]), the
    integral of each k_j over a substep of at most ``longest_rise`` [K] is Simpson's.
    """
    points = time.size
    components = start.size
    reactions = network.reactant.size
    mass = np.empty(points)
    rate = np.empty(points)
    m = start.copy().reshape(components, 1)
    m_new = np.empty((components, 1))
    formed = m.copy()
    x = np.empty((reactions, 1))
    used = np.empty((reactions, 1))
    k_old = np.empty(reactions)
    k_new = np.empty(reactions)
    for j in range(reactions):
        k_old[j] = _arrhenius(network, j, temperature[0])
    mass[0] = m.sum()
    rate[0] = _loss(m, formed, k_old, network)
    for n in range(1, points):
        rise = temperature[n] - temperature[n - 1]
        parts = max(1, math.ceil(abs(rise) / longest_rise))
        dt = (time[n] - time[n - 1]) / parts
        for s in range(parts):
            here = temperature[n - 1] + rise * s / parts
            there = temperature[n - 1] + rise * (s + 1) / parts
            for j in range(reactions):
                k_new[j] = _arrhenius(network, j, there)
                middle = _arrhenius(network, j, 0.5 * (here + there))
                x[j, 0] = dt * (k_old[j] + 4.0 * middle + k_new[j]) / 6.0
                k_old[j] = k_new[j]
            react(m, formed, 0, x, network, True, m_new, used)
            for j in range(reactions):
                for i in range(components):
                    formed[i, 0] += network.yields[j, i] * used[j, 0]
            for i in range(components):
                m[i, 0] = m_new[i, 0]
        mass[n] = m.sum()
        rate[n] = _loss(m, formed, k_old, network)
    return mass, rate


@entry
def _arrhenius(network, j, temperature):
    return network.rate_factor[j] * math.exp(-network.activation_temperature[j] / temperature)


@entry
def _loss(m, formed, k, network):
    loss = 0.0
    for j in range(k.size):
        i = network.reactant[j]
        r = k[j] * m[i, 0]
        if network.order[j] != 1.0 and m[i, 0] > 0.0:
            r *= (m[i, 0] / formed[i, 0]) ** (network.order[j] - 1.0)
        loss += network.gas[j] * r
    return loss
