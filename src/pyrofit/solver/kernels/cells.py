"""Properties and reaction rates of single cells."""

from pyrofit.compiled.jit import inner, live
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.functions import exp_of_negative, fma, nearly_inverse
from pyrofit.solver.kernels.lanes import in_lane, where
from pyrofit.solver.kernels.oxygen import is_of_oxygen
from pyrofit.solver.kernels.reactions import (
    TINY,
    brought,
    decay_of_order,
    is_curved,
    power_of_share,
    react,
    remaining,
)
from pyrofit.solver.kernels.tables import at_place, place_of

RATES_FROM_K, RATES_TO_K = 200.0, 2000.0
"""Range in which rates follow T."""
MOST_CORRECTION_K = 20.0
"""Difference T_new - T* up to which the rates are corrected."""
LEAST_RATE = 1.0e-100
"""Rate times heat capacity below which nothing is released."""
LEAST_RESISTANCE = 1.0e-13
"""[m2 K/W]; keeps vanished cells from dividing by zero."""


@inner
def layer(m, n, material, T):
    """Return thickness d [m], resistance d/k [m2 K/W] and capacity [J/(m2 K)] of cell n.

    k is mixed by volume, c by mass.
    """
    place = place_of(T)
    # Each case has a loop of its own: one for both keeps the places of all tables in memory.
    if nodes(material) == 1:
        return mixed(m, n, material, place, True)
    return mixed(m, n, material, place, False)


@inner
def mixed(m, n, material, place, constant):
    """Return the same at a place in the tables, which are constant or not."""
    d = 0.0 * place.part
    k = d
    c = d
    for i in range(m.shape[0]):
        v = m[i, n] * material.specific_volume[i] * at_place(material.expansion, i, place, constant)
        d += v
        k += v * at_place(material.conductivity, i, place, constant)
        c += m[i, n] * at_place(material.specific_heat, i, place, constant)
    return d, where(k > 0.0, d * d / max(k, TINY), 0.0), c


@inner
def describe(work, first, material):
    """Fill thickness, resistance and capacity of the cells, from m_new and T*.

    k is mixed by volume, c by mass.
    """
    cell = work.cell
    for n in live(work.m, first):
        none = 0.0 * work.m[0, n]
        cell[row.d, n] = none
        cell[row.dk, n] = none
        cell[row.C_new, n] = none
        cell[row.C_lost, n] = none
    if nodes(material) == 1:
        sum_constant(work, first, material)
    else:
        sum_tables(work, first, material)
    for n in live(work.m, first):
        d, dk = cell[row.d, n], cell[row.dk, n]
        cell[row.half_r, n] = fma(0.5 * d * d, nearly_inverse(max(dk, TINY)), LEAST_RESISTANCE)


@inner
def nodes(material):
    """Return the number of nodes of the longest table."""
    longest = max(material.expansion.shape[1], material.conductivity.shape[1])
    return max(longest, material.specific_heat.shape[1])


@inner
def sum_constant(work, first, material):
    """Fill thickness, times conductivity, and capacity of cells with constant properties."""
    cell = work.cell
    for i in range(work.m.shape[0]):
        volume, expansion = material.specific_volume[i], material.expansion[i, 0]
        k, c = material.conductivity[i, 0], material.specific_heat[i, 0]
        for n in live(work.m, first):
            m = work.m_new[i, n]
            v = m * volume * expansion
            cell[row.d, n] += v
            add_product(cell, row.dk, n, v, k)
            add_product(cell, row.C_new, n, m, c)
            add_product(cell, row.C_lost, n, work.m[i, n] - m, c)


@inner
def sum_tables(work, first, material):
    """Fill the same at T*; a table is looked up once for the components that share it."""
    cell = work.cell
    for n in live(work.m, first):
        place = place_of(cell[row.T_star, n])
        none = 0.0 * place.part
        expansion, k, c = none, none, none
        of = -1
        for i in range(work.m.shape[0]):
            if material.alike[i] != of:
                of, constant = material.alike[i], material.constant[i]
                expansion = at_place(material.expansion, of, place, constant)
                k = at_place(material.conductivity, of, place, constant)
                c = at_place(material.specific_heat, of, place, constant)
            m = work.m_new[i, n]
            v = m * material.specific_volume[i] * expansion
            cell[row.d, n] += v
            add_product(cell, row.dk, n, v, k)
            add_product(cell, row.C_new, n, m, c)
            add_product(cell, row.C_lost, n, work.m[i, n] - m, c)


@inner
def mean_capacity(cell, n):
    """Return the mean of C over the step: logarithmic, and more where gas is released ever faster.

    The cubic with the ends C and C_new, and slopes in proportion to the rates r there, has the mean
    (C + C_new)/2 + (C - C_new) (r_new - r)/(6 (r_new + r)). The result is this to first order in
    r_new/r. Where C falls exponentially, r_new/r = C_new/C, it is the logarithmic mean
    m (1 - d^2/3 - 4 d^4/45), d = (C_new - C)/(C_new + C). The same holds where C changes with
    temperature only.
    """
    C, C_new = cell[row.C, n], cell[row.C_new, n]
    both = max(C + C_new, TINY)
    before, after = cell[row.rate_old, n] * C_new, cell[row.rate, n] * C
    rates = max(abs(after) + abs(before), LEAST_RATE)
    # One division for both quotients; it runs beside the other operations.
    share = 1.0 / max(both * rates, TINY)
    d = (C_new - C) * (rates * share)
    d2 = d * d
    mean = 0.5 * both * fma(d2, fma(d2, -4.0 / 45.0, -1.0 / 3.0), 1.0)
    return fma((1.0 / 6.0) * cell[row.C_lost, n], (after - before) * (both * share), mean)


@inner
def fill_rate_constants(work, first, network):
    """Fill the roots of k_j [1/s] at T*, averaged over a linear temperature profile in each cell.

    The mean of exp(b x) over |x| <= ``fall`` is sinh(s)/s with s = b fall, b = E/(R T^2); the
    series of its root is cut after s^4.
    """
    cell = work.cell
    for n in live(work.m, first):
        T = min(max(cell[row.T_star, n], RATES_FROM_K), RATES_TO_K)
        inverse_T = nearly_inverse(T)
        cell[row.inverse_T, n] = inverse_T
        cell[row.bend, n] = 2.0 * cell[row.fall, n] * inverse_T
    for j in range(work.root.shape[0]):
        half_E = 0.5 * network.activation_temperature[j]
        scale = network.root_factor[j]
        for n in live(work.m, first):
            e = half_E * cell[row.inverse_T, n]
            s = e * cell[row.bend, n]
            s2 = min(s * s, 9.0)
            factor = fma(s2, fma(s2, 1.0 / 1440.0, 1.0 / 12.0), 1.0)
            work.root_new[j, n] = scale * exp_of_negative(e) * factor


@inner
def correct_rate_constants(work, first, network):
    """Bring k_j from T* to T_new, its root to second order in the difference."""
    cell = work.cell
    for n in live(work.m, first):
        change = cell[row.T_new, n] - cell[row.T_star, n]
        change = min(max(change, -MOST_CORRECTION_K), MOST_CORRECTION_K)
        inverse_T = cell[row.inverse_T, n]
        cell[row.bend, n] = 0.5 * change * inverse_T * inverse_T
    for j in range(work.root.shape[0]):
        E = network.activation_temperature[j]
        for n in live(work.m, first):
            y = E * cell[row.bend, n]
            work.root_new[j, n] *= fma(y, fma(y, 0.5, 1.0), 1.0)


@inner
def log_mean(root_a, root_b):
    """Return the mean of an exponential from a to b, and its derivative in b times b.

    The logarithmic mean (b - a)/ln(b/a), to fourth order in ln(b/a): (2 sqrt(a b) + (a + b)/2)/3.
    """
    third = (1.0 / 3.0) * root_a * root_b
    b = root_b * root_b
    both = fma(root_a, root_a, b)
    return fma(1.0 / 6.0, both, 2.0 * third), fma(1.0 / 6.0, b, third)


@inner
def react_over(work, first, dt, room, network, final):
    """Fill the masses and the rows of `book` that follow from k_j over a step of the cells."""
    cell = work.cell
    for n in live(work.m, first):
        none = 0.0 * work.m[0, n]
        cell[row.heat, n] = none
        cell[row.rate, n] = none
        if final:
            cell[row.gas, n] = none
            cell[row.burnt, n] = none
            cell[row.power, n] = none
        else:
            cell[row.grows, n] = none
    if network.plain:
        react_alone(work, first, dt, network, final)
        return
    for n in live(work.m, first):
        for j in range(work.root.shape[0]):
            mean, growth = log_mean(work.root[j, n], work.root_new[j, n])
            room.x[j] = dt * work.open[j] * mean
            room.growth[j] = dt * growth
        react(work.m, work.formed, n, room, network, False, work.m_new)
        for j in range(work.root.shape[0]):
            left = work.m_new[network.reactant[j], n]
            if not network.first_order:
                left = left * room.behind[j]
            if network.oxidises:
                left = left * work.open_end[j]
            book(work, n, j, room.used[j], left, room.growth[j], network, final)
        if not network.first_order:
            for i in range(work.m.shape[0]):
                work.formed_new[i, n] = ever_formed(work, i, n, room, network)


@inner
def react_alone(work, first, dt, network, final):
    """Let reactions that have nothing to do with each other act one after the other."""
    for i in range(work.m.shape[0]):
        if not is_consumed(i, network):
            for n in live(work.m, first):
                work.m_new[i, n] = work.m[i, n]
    for j in range(work.root.shape[0]):
        # Each loop over the cells has one case: a branch inside would cost registers.
        if is_curved(network, j) or network.oxidises:
            if not final:
                hold_powers(work, first, j, network)
            react_one(work, first, j, dt, network, True, final)
        else:
            react_one(work, first, j, dt, network, False, final)


@inner
def react_one(work, first, j, dt, network, curved, final):
    """Let reaction j act in all cells."""
    i, residue = network.reactant[j], network.residue[j]
    share, order = network.residue_yield[j], network.order[j]
    for n in live(work.m, first):
        mean, growth = log_mean(work.root[j, n], work.root_new[j, n])
        x, behind = dt * mean, 1.0
        if curved:
            m, ever, held = work.m[i, n], work.formed[i, n], work.held[j, n]
            x, behind = brought(m, ever, held, work.open[j] * x, j, network)
            behind = work.open_end[j] * behind
        e, _ = decay_of_order(x, order, curved, False)
        left, used = remaining(work.m[i, n], e)
        work.m_new[i, n] = left
        work.m_new[residue, n] = fma(share, used, work.m_new[residue, n])
        book(work, n, j, used, left * behind, dt * growth, network, final)


@inner
def hold_powers(work, first, j, network):
    """Fill u^(n-1) of the reactant of reaction j at the start of the step."""
    i, order = network.reactant[j], network.order[j]
    for n in live(work.m, first):
        work.held[j, n] = power_of_share(work.m[i, n], work.formed[i, n], order)


@inner
def is_consumed(i, network):
    """Tell whether a component is a reactant."""
    found = False
    for j in range(network.reactant.size):
        found = found or network.reactant[j] == i
    return found


@inner
def add_product(cell, to, n, factor, value):
    """Add a product to a row of cell n."""
    cell[to, n] = fma(factor, value, cell[to, n])


@inner
def book(work, n, j, used, left, growth, network, final):
    """Add the contributions of reaction j to heat used and rate of cell n.

    If the step is final also to the gas and its heat of combustion, else to
    sum_j dh_j E_j/R (d x_j / d ln k_j) m_j. That sum is T^2 times the slope of the heat used in T.
    """
    cell = work.cell
    heat, gas = network.heat[j], network.gas[j]
    root = work.root_new[j, n]
    speed = root * root * left
    add_product(cell, row.heat, n, heat, used)
    add_product(cell, row.rate, n, gas, speed)
    if final:
        add_product(cell, row.gas, n, gas, used)
        if network.burns:
            burning = work.burning[j]
            add_product(cell, row.burnt, n, burning, used)
            add_product(cell, row.power, n, burning, speed)
    else:
        rise = heat * network.activation_temperature[j]
        add_product(cell, row.grows, n, rise, growth * left)


@inner
def ever_formed(work, i, n, room, network):
    """Return the mass of component i that has ever been in cell n, up to the end of the step."""
    formed = work.formed[i, n]
    for j in range(work.root.shape[0]):
        formed += network.yields[j, i] * room.used[j]
    return formed


@inner
def reactant_left(m, n, network):
    """Return the mass of cell n that can still react [kg/m2]."""
    left = 0.0 * m[0, n]
    for j in range(network.reactant.size):
        if j == 0 or network.reactant[j] != network.reactant[j - 1]:
            reactant = m[network.reactant[j], n]
            if is_of_oxygen(network, j):
                reactant = where(network.root_factor[j] > 0.0, reactant, 0.0)
            left += reactant
    return left


@inner
def reactant_in_lane(m, n, lane, network):
    """Return the mass of cell n that can still react in one lane [kg/m2]."""
    left = 0.0
    for j in range(network.reactant.size):
        first = j == 0 or network.reactant[j] != network.reactant[j - 1]
        runs = not is_of_oxygen(network, j) or in_lane(network.root_factor[j], lane) > 0.0
        if first and runs:
            left += m[network.reactant[j], n, lane]
    return left
