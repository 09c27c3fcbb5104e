"""Reactions that need oxygen: k_j = A_j exp(-E_j/(R T)) X_s^n exp(-n x/L), x below the surface.

X_s, the volume fraction of oxygen at the surface, is that of the gas, X, unless reactions use up
oxygen. Then convection supplies their use, K_j their rates at X_s = 1:

    S (X - X_s) = sum_j s_j K_j X_s^n_j        S = (h/c_p) M_O2/M_air

The depth x follows
from the thickness of the cells, so that the surface recedes as they burn. Over a cell ln k falls
with depth by n d/L besides its fall with temperature; the mean takes both.
"""

from pyrofit.compiled.jit import inner, live, loop
from pyrofit.constants import AIR_HEAT_CAPACITY, OXYGEN_OVER_AIR
from pyrofit.solver.arrays import LIT, OXYGEN
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.functions import exp, exp_of_negative, fma, log, power
from pyrofit.solver.kernels.lanes import somewhere, where
from pyrofit.solver.kernels.reactions import TINY, is_curved, power_of_share, quickening
from pyrofit.solver.kernels.schedule import during

NEWTON_STEPS = 6
"""From the start of `log_of_rest` six steps end within 1e-12 of the root for one reaction."""


@inner
def is_of_oxygen(network, j):
    """Tell whether reaction j needs oxygen in some lane, and is the only one of its reactant."""
    end = network.reactant.size - 1
    alone = j == end or network.reactant[j] != network.reactant[j + 1]
    return alone and somewhere(network.oxygen_order[j] > 0.0)


@inner
def close(work, none, network):
    """Fill what holds without oxygen: no factor, and the heat of combustion of all gas."""
    for j in range(network.reactant.size):
        work.open[j] = none + 1.0
        work.open_end[j] = none + 1.0
        work.burning[j] = none + network.combustion[j] * network.gas[j]


@loop
def open_up(work, piece, schedule, network):
    """Fill X_s^n, and the heat released: of gas while it burns, of the solid always."""
    X = during(piece, OXYGEN, schedule)
    lit = during(piece, LIT, schedule)
    for j in range(network.reactant.size):
        n = network.oxygen_order[j]
        some = where(X > 0.0, power(max(X, TINY), n), 0.0)
        work.open[j] = where(n > 0.0, some, 1.0)
        work.open_end[j] = work.open[j]
        work.full[j] = work.open[j]
        work.burning[j] = fma(lit, network.combustion[j] * network.gas[j], network.glow[j])


@inner
def is_short(network):
    """Tell whether a reaction uses up oxygen in some lane."""
    short = False
    for j in range(network.reactant.size):
        short = short or somewhere(network.oxygen_use[j] > 0.0)
    return short


@inner
def compare_need(work, first, m, root, supplied, network):
    """Fill what reactions would use up at the oxygen of the gas, over the supply to X_s = 0."""
    for j in range(network.reactant.size):
        i, order = network.reactant[j], network.order[j]
        rate = 0.0 * supplied
        for n in live(work.m, first):
            amount = m[i, n]
            if is_curved(network, j):
                u = amount / max(work.formed[i, n], TINY)
                amount = amount * power_of_share(amount, work.formed[i, n], order)
                if network.catalysed:
                    amount = amount * quickening(u, j, network)
            rate = fma(root[j, n] * root[j, n], amount, rate)
        used = where(network.oxygen_order[j] > 0.0, network.oxygen_use[j] * work.full[j], 0.0)
        work.need[j] = used * rate / max(supplied, 1e-100)


@inner
def log_of_rest(work, supplied, network):
    """Return z = ln(X_s/X) of 1 - e^z = sum_j a_j e^(n_j z), a_j the needs.

    The difference of the two sides falls ever faster with z. So Newton's method, begun where no
    term exceeds 1, comes down to the root without passing it.
    """
    z = 0.0 * supplied
    for j in range(network.reactant.size):
        n = max(network.oxygen_order[j], 1e-3)
        z = min(z, -log(max(work.need[j], 1.0)) / n)
    for _ in range(NEWTON_STEPS):
        rest = exp(z)
        off, slope = 1.0 - rest, rest
        for j in range(network.reactant.size):
            n = network.oxygen_order[j]
            used = work.need[j] * exp(n * z)
            off -= used
            slope = fma(n, used, slope)
        z += off / slope
    return z


@loop
def share_supply(work, first, behind, h, piece, schedule, network):
    """Lower the factors of `open_up` to the supply by a convection of h [W/(m2 K)].

    ``behind`` holds masses at the end of the step, as far as they are known.
    """
    X = during(piece, OXYGEN, schedule)
    supplied = (OXYGEN_OVER_AIR / AIR_HEAT_CAPACITY) * h * X
    compare_need(work, first, work.m, work.root, supplied, network)
    start = log_of_rest(work, supplied, network)
    compare_need(work, first, behind, work.root_new, supplied, network)
    end = log_of_rest(work, supplied, network)
    for j in range(network.reactant.size):
        n = network.oxygen_order[j]
        work.open_end[j] = work.full[j] * exp(n * end)
        work.open[j] = 0.5 * fma(work.full[j], exp(n * start), work.open_end[j])


@loop
def measure_depths(work, first, skin):
    """Fill the new depths of the cells, behind a skin of so much thickness, and their change."""
    cell = work.cell
    front = skin
    for n in live(work.m, first):
        half = 0.5 * cell[row.d, n]
        middle = front + half
        cell[row.deeper, n] = middle - cell[row.depth_new, n]
        cell[row.depth_new, n] = middle
        front = middle + half


@inner
def begin_depths(work):
    """Fill the depths at the start."""
    cell = work.cell
    measure_depths(work, 0, 0.0 * cell[row.T, 0])
    for n in live(work.m, 0):
        cell[row.depth, n] = cell[row.depth_new, n]
        cell[row.depth_old, n] = cell[row.depth_new, n]


@loop
def extrapolate_depths(work, first, r):
    """Fill the new depths as they go on from the step before."""
    cell = work.cell
    for n in live(work.m, first):
        depth = cell[row.depth, n]
        cell[row.depth_new, n] = fma(r, depth - cell[row.depth_old, n], depth)


@loop
def fill_in_depth(work, first, network):
    """Fill the roots of k_j of the reactions with oxygen, see `cells.fill_rate_constants`."""
    cell = work.cell
    for j in range(work.root.shape[0]):
        fall = network.oxygen_fall[j]
        if somewhere(fall != 0.0):
            half_E, scale = 0.5 * network.activation_temperature[j], network.root_factor[j]
            for n in live(work.m, first):
                e = half_E * cell[row.inverse_T, n]
                s = fma(e, cell[row.bend, n], 0.5 * fall * cell[row.d, n])
                s2 = min(s * s, 9.0)
                factor = fma(s2, fma(s2, 1.0 / 1440.0, 1.0 / 12.0), 1.0)
                x = fma(0.5 * fall, cell[row.depth_new, n], e)
                work.root_new[j, n] = scale * exp_of_negative(x) * factor


@loop
def correct_in_depth(work, first, network):
    """Bring the roots of k_j to the depths corrected."""
    cell = work.cell
    for j in range(work.root.shape[0]):
        fall = network.oxygen_fall[j]
        if somewhere(fall != 0.0):
            for n in live(work.m, first):
                work.root_new[j, n] *= exp(-0.5 * fall * cell[row.deeper, n])
