"""How many cells a slab needs: cells about as thick as the zone in which it reacts.

Behind a surface that takes up the net flux q the temperature falls by q/k per metre. A rate of
activation energy E falls e-fold within the width of the reaction zone, delta = k R T^2 / (E q). The
spatial error goes with the square of cell thickness over delta.
"""

import math

import numpy as np

from pyrofit.compiled.jit import entry, inner
from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.solver.arrays import FLAME, FLUX, FRONT_GAS, FRONT_H, FRONT_WALL
from pyrofit.solver.kernels.functions import log
from pyrofit.solver.kernels.tables import at_temperature

LEAST_CELLS, MOST_CELLS = 50, 2000
CELLS_PER_ZONE = 1.2
MANY_CELLS = 100.0
"""The error grows a little with the number of cells, too: above this number it is multiplied by the
eighth root of its ratio to this one."""
CELLS_PER_DEPTH = 5.0
"""In the depth in which a reaction with oxygen falls to 1/e."""
CELLS_FOR_CHAR = 2.0
"""So many times more where the residue keeps the volume of the virgin material."""
STEEPEST_RISE = 4.0
"""A residue that absorbs better lets the surface heat itself up, the faster the better; how fast
depends on the topmost cell. The ratio of emissivities, up to this one, to the power 0.75."""
LEAST_NET_SHARE = 0.02
"""Net share of the absorbed flux at least; a surface near its equilibrium has no front."""
LEAST_HEAT = 2.0e5
"""Heat of gasification at least [J/kg]."""
COLDEST_K, HOTTEST_K, FIRST_GUESS_K = 350.0, 1500.0, 650.0


@inner
def _formed_and_left(share, ever, left, network, s):
    """Fill the mass of each component ever present, and the mass left, per virgin mass.

    Competing reactions of one reactant count alike.
    """
    for i in range(share.shape[0]):
        ever[i] = share[i, s]
        left[i] = share[i, s]
    reactions = network.reactant.size
    for j in range(reactions):
        i = network.reactant[j]
        if (j > 0 and network.reactant[j - 1] == i) or network.oxygen_order[j, s] > 0.0:
            continue
        end = j + 1
        while end < reactions and network.reactant[end] == i:
            end += 1
        for b in range(share.shape[0]):
            formed = 0.0
            for a in range(j, end):
                formed += network.yields[a, b, s]
            ever[b] += formed / (end - j) * ever[i]
            left[b] += formed / (end - j) * left[i]
        left[i] = 0.0


@inner
def _reaction_zone(j, eps, share, T_start, material, network, exposure, s):
    """Return delta [m] of reaction j at the temperature at which its front moves steadily.

    There the zone releases the mass that the net flux can heat and convert:
    rho delta k_j = q / (c dT + dh).
    """
    E = network.activation_temperature[j, s]
    A = network.root_factor[j, s] * network.root_factor[j, s]
    schedule = exposure.schedule
    wall, gas, h = schedule[FRONT_WALL, 0, s], schedule[FRONT_GAS, 0, s], schedule[FRONT_H, 0, s]
    strongest = 0.0
    for p in range(schedule.shape[1]):
        strongest = max(strongest, schedule[FLUX, p, s] + schedule[FLAME, p, s])
        wall = max(wall, schedule[FRONT_WALL, p, s])
        gas = max(gas, schedule[FRONT_GAS, p, s])
        h = min(h, schedule[FRONT_H, p, s])
    T, width = FIRST_GUESS_K, math.inf
    for _ in range(4):
        loss = eps * STEFAN_BOLTZMANN * (T * T * T * T - wall * wall * wall * wall)
        loss += h * (T - gas)
        q = max(eps * strongest - loss, LEAST_NET_SHARE * eps * strongest, 1.0)
        volume = k = c = 0.0
        for i in range(share.shape[0]):
            v = share[i, s] * material.specific_volume[i, s]
            volume += v
            k += v * at_temperature(material.conductivity[:, :, s], i, T)
            c += share[i, s] * at_temperature(material.specific_heat[:, :, s], i, T)
        width = k / volume * T * T / (E * q)
        heat = max(c * (T - T_start[s]) + network.heat[j, s], LEAST_HEAT)
        rate = q * volume / (heat * width)
        T = min(max(E / log(max(A / rate, 1.01)), COLDEST_K), HOTTEST_K)
    return width


@entry
def cells_needed(share, thickness, T_start, material, network, exposure):
    """Return the number of cells that keeps the spatial error of the mass loss rate near 0.1 %.

    Parameters
    ----------
    share : mass fractions of the front layer, shape (components, sets).
    thickness, T_start : of the virgin sample [m], [K], shape (sets,).
    material, network, exposure : see `pyrofit.solver.arrays`.

    Returns
    -------
    numbers, shape (sets,). Measured: see ``tests/verification/test_slab_convergence.py``.
    """
    components = share.shape[0]
    cells = np.empty(thickness.size, np.int64)
    ever, left = np.empty(components), np.empty(components)
    for s in range(thickness.size):
        _formed_and_left(share, ever, left, network, s)
        volume = stays = shine = eps = 0.0
        for i in range(components):
            v = share[i, s] * material.specific_volume[i, s]
            volume += v
            shine += v * material.emissivity[i, s]
            stays += left[i] * material.specific_volume[i, s]
            if ever[i] > 0.0:
                eps = max(eps, material.emissivity[i, s])
        most, depths = 0.0, 0.0
        for j in range(network.reactant.size):
            gas = ever[network.reactant[j]] * network.gas[j, s]
            if network.oxygen_order[j, s] > 0.0:
                if network.root_factor[j, s] > 0.0:
                    in_depth = thickness[s] * network.oxygen_fall[j, s]
                    depths = max(depths, CELLS_PER_DEPTH * in_depth)
            elif gas > 0.0 and network.activation_temperature[j, s] > 0.0:
                width = _reaction_zone(j, eps, share, T_start, material, network, exposure, s)
                most = max(most, math.sqrt(min(gas, 1.0)) * thickness[s] / width)
        rise = eps * volume / max(shine, 1e-9 * volume)
        factor = CELLS_PER_ZONE * math.sqrt(math.sqrt(min(rise, STEEPEST_RISE) ** 3))
        factor *= 1.0 + CELLS_FOR_CHAR * min(stays / volume, 1.0)
        many = max(factor * most / MANY_CELLS, 1.0)
        needed = factor * most * math.sqrt(math.sqrt(math.sqrt(many)))
        cells[s] = min(max(math.ceil(max(needed, depths)), LEAST_CELLS), MOST_CELLS)
    return cells
