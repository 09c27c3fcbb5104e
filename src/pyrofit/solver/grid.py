"""How many cells a slab needs: cells about as thick as the zone in which it reacts.

Behind a surface that takes up the net flux q the temperature falls by q/k per metre, and a rate of
activation energy E falls e-fold within the width of the reaction zone, delta = k R T^2 / (E q). The
spatial error goes with the square of cell thickness over delta.
"""

import math
from typing import NamedTuple

from pyrofit.constants import STEFAN_BOLTZMANN
from pyrofit.solver.arrays import (
    TABLE_SIZE,
    TABLE_START_K,
    TABLE_STEP_K,
    Exposure,
    FloatArray,
    Material,
    Network,
)

LEAST_CELLS, MOST_CELLS = 50, 2000
CELLS_PER_ZONE = 1.2
CELLS_FOR_CHAR = 2.0
"""So many times more where the residue keeps the volume of the virgin material."""
STEEPEST_RISE, RISE_EXPONENT = 4.0, 0.75
"""A residue that absorbs better lets the surface heat itself up, the faster the better; how fast
depends on the topmost cell. The ratio of emissivities, up to this one, to this power."""
LEAST_NET_SHARE = 0.02
"""Net share of the absorbed flux at least; a surface near its equilibrium has no front."""
LEAST_HEAT = 2.0e5
"""Heat of gasification at least [J/kg]."""
COLDEST_K, HOTTEST_K, FIRST_GUESS_K = 350.0, 1500.0, 650.0


class Virgin(NamedTuple):
    """The sample before it reacts."""

    share: FloatArray
    """Mass fractions of the front layer, shape (components,)."""
    thickness: float
    """[m]."""
    temperature: float
    """[K]."""


def cells_needed(virgin: Virgin, material: Material, network: Network, exposure: Exposure) -> int:
    """Return the number of cells that keeps the spatial error of the mass loss rate near 0.1 %.

    ``material``, ``network`` and ``exposure`` are the lowered description. Measured: see
    ``tests/verification/test_slab_convergence.py``.
    """
    share = virgin.share.tolist()
    specific_volume = material.specific_volume.tolist()
    emissivity = material.emissivity.tolist()
    volume = [y * v for y, v in zip(share, specific_volume, strict=True)]
    ever, left = _formed_and_left(share, network)
    eps = max(e for e, y in zip(emissivity, ever, strict=True) if y > 0.0)
    most = 0.0
    for j, i in enumerate(network.reactant.tolist()):
        gas = ever[i] * float(network.gas[j])
        if gas > 0.0 and network.activation_temperature[j] > 0.0:
            width = _reaction_zone(j, eps, virgin, volume, material, network, exposure)
            most = max(most, math.sqrt(min(gas, 1.0)) * virgin.thickness / width)
    rise = eps * sum(volume) / max(_dot(volume, emissivity), 1e-9 * sum(volume))
    stays = _dot(left, specific_volume) / sum(volume)
    factor = CELLS_PER_ZONE * min(rise, STEEPEST_RISE) ** RISE_EXPONENT
    factor *= 1.0 + CELLS_FOR_CHAR * min(stays, 1.0)
    cells: int = math.ceil(factor * most)
    return min(max(cells, LEAST_CELLS), MOST_CELLS)


def _formed_and_left(share: list[float], network: Network) -> tuple[list[float], list[float]]:
    """Return the mass of each component ever present, and what is left, per virgin mass.

    Competing reactions of one reactant count alike.
    """
    ever = share.copy()
    left = share.copy()
    reactants = network.reactant.tolist()
    yields = network.yields.tolist()
    for i in dict.fromkeys(reactants):
        formed = [nus for a, nus in zip(reactants, yields, strict=True) if a == i]
        for product, nus in enumerate(zip(*formed, strict=True)):
            ever[product] += sum(nus) / len(nus) * ever[i]
            left[product] += sum(nus) / len(nus) * left[i]
        left[i] = 0.0
    return ever, left


def _reaction_zone(
    j: int,
    eps: float,
    virgin: Virgin,
    volume: list[float],
    material: Material,
    network: Network,
    exposure: Exposure,
) -> float:
    """Return delta [m] of reaction j at the temperature at which its front moves steadily.

    There the zone releases what the net flux can heat and convert: rho delta k_j = q / (c dT + dh).
    """
    front = exposure.front
    share = virgin.share.tolist()
    E, A = float(network.activation_temperature[j]), float(network.rate_factor[j])
    dh = float(network.heat[j])
    absorbed = eps * float(exposure.flux.max())
    T, width = FIRST_GUESS_K, math.inf
    for _ in range(4):
        loss = eps * STEFAN_BOLTZMANN * (T**4 - front.wall_temperature**4)
        loss += front.h * (T - front.gas_temperature)
        q = max(absorbed - loss, LEAST_NET_SHARE * absorbed, 1.0)
        k = _dot(volume, _at(material.conductivity, T)) / sum(volume)
        c = _dot(share, _at(material.specific_heat, T))
        width = k * T * T / (E * q)
        heat = max(c * (T - virgin.temperature) + dh, LEAST_HEAT)
        rate = q * sum(volume) / (heat * width)
        T = E / math.log(max(A / rate, 1.01))
        T = min(max(T, COLDEST_K), HOTTEST_K)
    return width


def _dot(a: list[float], b: list[float]) -> float:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _at(table: FloatArray, T: float) -> list[float]:
    """Return the properties of all components at T, shape (components,)."""
    if table.shape[1] == 1:
        return [row[0] for row in table.tolist()]
    x = (T - TABLE_START_K) / TABLE_STEP_K
    p = min(int(x), TABLE_SIZE - 2)
    return list((table[:, p] + (x - p) * (table[:, p + 1] - table[:, p])).tolist())
