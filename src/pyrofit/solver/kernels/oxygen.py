"""Reactions that need oxygen: k_j = A_j exp(-E_j/(R T)) X_s^n exp(-n x/L), x below the surface.

X_s, the volume fraction of oxygen at the surface, is the same during a step. The depth x follows
from the thickness of the cells, so that the surface recedes as they burn. Over a cell ln k falls
with depth by n d/L besides its fall with temperature; the mean takes both.
"""

from pyrofit.solver.arrays import LIT, OXYGEN
from pyrofit.solver.kernels import row
from pyrofit.solver.kernels.functions import exp, exp_of_negative, fma, power
from pyrofit.solver.kernels.jit import inner, live, loop
from pyrofit.solver.kernels.lanes import somewhere, where
from pyrofit.solver.kernels.reactions import TINY
from pyrofit.solver.kernels.schedule import during


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
        work.burning[j] = fma(lit, network.combustion[j] * network.gas[j], network.glow[j])


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
