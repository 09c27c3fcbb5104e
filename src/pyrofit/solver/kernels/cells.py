"""Properties and reaction rates of single cells."""

import math

from pyrofit.solver.arrays import TABLE_SIZE, TABLE_START_K, TABLE_STEP_K
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.jit import inner, live

RATES_FROM_K, RATES_TO_K = 200.0, 2000.0
"""Range in which rates follow T."""
MOST_CORRECTION_K = 20.0
"""Difference T_new - T* up to which the rates are corrected."""
LEAST_RESISTANCE = 1.0e-13
"""[m2 K/W]; keeps vanished cells from dividing by zero."""
LEAST_DEPTH = 1.0e-9
"""Depth [m] from which a surface radiates at least."""
TABLE_END_K = TABLE_START_K + TABLE_STEP_K * (TABLE_SIZE - 1)


@inner
def at_temperature(table, i, T):
    """Return property i at T, linear between the table's nodes; one column = constant."""
    if table.shape[1] == 1:
        return table[i, 0]
    x = (min(max(T, TABLE_START_K), TABLE_END_K) - TABLE_START_K) / TABLE_STEP_K
    p = min(int(x), TABLE_SIZE - 2)
    return table[i, p] + (x - p) * (table[i, p + 1] - table[i, p])


@inner
def layer(m, n, material, T):
    """Return thickness d [m], resistance d/k [m2 K/W] and capacity [J/(m2 K)] of cell n.

    k is mixed by volume, c by mass.
    """
    d = 0.0
    k = 0.0
    c = 0.0
    for i in range(m.shape[0]):
        v = m[i, n] * material.specific_volume[i] * at_temperature(material.expansion, i, T)
        d += v
        k += v * at_temperature(material.conductivity, i, T)
        c += m[i, n] * at_temperature(material.specific_heat, i, T)
    return d, (d * d / k if k > 0.0 else 0.0), c


@inner
def optical_depth(m, n, material):
    """Return kappa d [-] of cell n, the absorption coefficient mixed by volume."""
    optical = 0.0
    for i in range(m.shape[0]):
        optical += m[i, n] * material.specific_volume[i] * material.absorption[i]
    return optical


@inner
def emitting_layer(m, n, material):
    """Return thickness d [m] and eps d [m] of cell n, the emissivity mixed by volume."""
    d = 0.0
    e = 0.0
    for i in range(m.shape[0]):
        v = m[i, n] * material.specific_volume[i]
        d += v
        e += v * material.emissivity[i]
    return d, e


@inner
def top_emissivity(depth, skin, m, first, material, before):
    """Return the volume-averaged emissivity of the top ``depth`` of the current sample.

    A sample that has vanished keeps the value it had ``before``.
    """
    depth = max(depth, LEAST_DEPTH)
    z, total = emitting_layer(skin, 0, material)
    if z >= depth:
        return total / z
    for n in live(m, first):
        d, e = emitting_layer(m, n, material)
        if d >= depth - z:
            return (total + (depth - z) / d * e) / depth
        total += e
        z += d
    return total / z if z > 0.0 else before


@inner
def mix(amount, table, cell, first, to):
    """Fill row ``to`` of the cells with sum_i amount_i p_i(T*)."""
    for n in live(amount, first):
        cell[to, n] = 0.0
    for i in range(amount.shape[0]):
        for n in live(amount, first):
            cell[to, n] += amount[i, n] * at_temperature(table, i, cell[row.T_star, n])


@inner
def properties(work, first, material):
    """Fill volumes, thickness, resistance and capacity of the cells, from m_new and T*.

    k is mixed by volume, c by mass.
    """
    cell = work.cell
    for n in live(work.m, first):
        cell[row.d, n] = 0.0
    for i in range(work.m.shape[0]):
        for n in live(work.m, first):
            chi = at_temperature(material.expansion, i, cell[row.T_star, n])
            work.v[i, n] = work.m_new[i, n] * material.specific_volume[i] * chi
            cell[row.d, n] += work.v[i, n]
    mix(work.v, material.conductivity, cell, first, row.dk)
    mix(work.m_new, material.specific_heat, cell, first, row.C_new)
    for n in live(work.m, first):
        d = cell[row.d, n]
        dk = cell[row.dk, n]
        cell[row.half_r, n] = (0.5 * d * d / dk if dk > 0.0 else 0.0) + LEAST_RESISTANCE


@inner
def rate_constants(work, first, network):
    """Fill k_j [1/s] at T*, averaged over a linear temperature profile in each cell.

    The mean of exp(b x) over |x| <= ``fall`` is sinh(s)/s with s = b fall, b = E/(R T^2); its
    series is cut after s^4.
    """
    cell = work.cell
    for n in live(work.m, first):
        cell[row.inverse_T, n] = 1.0 / min(max(cell[row.T_star, n], RATES_FROM_K), RATES_TO_K)
    for j in range(work.k.shape[0]):
        for n in live(work.m, first):
            e = network.activation_temperature[j] * cell[row.inverse_T, n]
            s = e * cell[row.fall, n] * cell[row.inverse_T, n]
            s2 = min(s * s, 9.0)
            factor = 1.0 + s2 * (1.0 / 6.0 + s2 * (1.0 / 120.0))
            work.k_new[j, n] = network.rate_factor[j] * math.exp(-e) * factor


@inner
def correct_rate_constants(work, first, network):
    """Bring k_j from T* to T_new, to second order in the difference."""
    cell = work.cell
    for n in live(work.m, first):
        change = cell[row.T_new, n] - cell[row.T_star, n]
        change = min(max(change, -MOST_CORRECTION_K), MOST_CORRECTION_K)
        cell[row.change, n] = change * cell[row.inverse_T, n] * cell[row.inverse_T, n]
    for j in range(work.k.shape[0]):
        for n in live(work.m, first):
            y = network.activation_temperature[j] * cell[row.change, n]
            work.k_new[j, n] *= 1.0 + y * (1.0 + 0.5 * y)


@inner
def log_mean(a, b):
    """Return the mean of what grows exponentially from a to b, and its derivative times b.

    The logarithmic mean (b - a)/ln(b/a), to fourth order in ln(b/a): (2 sqrt(a b) + (a + b)/2)/3.
    """
    root = math.sqrt(a * b)
    return (2.0 / 3.0) * root + (1.0 / 6.0) * (a + b), (1.0 / 3.0) * root + (1.0 / 6.0) * b


@inner
def integrate_rate_constants(work, first, dt):
    """Fill the integrals x_j of k_j over the step and how they grow with ln k_j."""
    for j in range(work.k.shape[0]):
        for n in live(work.m, first):
            mean, growth = log_mean(work.k[j, n], work.k_new[j, n])
            work.x[j, n] = dt * mean
            work.growth[j, n] = dt * growth


@inner
def ever_formed(work, i, n, network):
    """Return the mass of component i that has ever been in cell n, up to the end of the step."""
    formed = work.formed[i, n]
    for j in range(work.k.shape[0]):
        formed += network.yields[j, i] * work.used[j, n]
    return formed


@inner
def mass_loss_rate(work, first, network):
    """Fill the masses that the rates r_j are proportional to; return sum_j gas_j r_j."""
    total = 0.0
    for j in range(work.k.shape[0]):
        i = network.reactant[j]
        for n in live(work.m, first):
            work.left[j, n] = work.m_new[i, n]
        if not network.first_order and network.order[j] != 1.0:
            for n in live(work.m, first):
                if work.left[j, n] > 0.0:
                    u = work.m_new[i, n] / ever_formed(work, i, n, network)
                    work.left[j, n] *= u ** (network.order[j] - 1.0)
        for n in live(work.m, first):
            total += network.gas[j] * work.k_new[j, n] * work.left[j, n]
    return total


@inner
def reactant_left(m, n, network):
    """Return the mass of cell n that can still react [kg/m2]."""
    left = 0.0
    for j in range(network.reactant.size):
        if j == 0 or network.reactant[j] != network.reactant[j - 1]:
            left += m[network.reactant[j], n]
    return left
