"""The oxygen that convection supplies to the front of a slab."""

import numpy as np

from pyrofit.constants import AIR_HEAT_CAPACITY, OXYGEN_OVER_AIR
from pyrofit.numerics import functions
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.reference.substance import Reactions

NEWTON_STEPS = 8
NEGLIGIBLE = 1e-14
"""Use of oxygen over its supply."""


def rest_of_oxygen(
    rate: FloatArray, oxygen: FloatArray | float, h: FloatArray, reactions: Reactions
) -> FloatArray:
    """Return the factors (X_s/X)^n of the rates at the oxygen X of the gas.

    X_s is at the surface: (h/c_p) M_O2/M_air (X - X_s) = sum_j s_j r_j (X_s/X)^n_j.

    Parameters
    ----------
    rate
        r_j, the rates at X [kg/(m2 s)], shape (..., 1, reactions), like the result.
    oxygen, h
        X [-] and heat transfer coefficient [W/(m2 K)], numbers or of shape (..., 1, 1).
    """
    n = reactions.oxygen_order
    supplied = (OXYGEN_OVER_AIR / AIR_HEAT_CAPACITY) * h * np.asarray(oxygen)
    used = np.where(n > 0.0, reactions.oxygen_use * rate, 0.0)
    need = used / np.maximum(supplied, 1e-100)
    if need.max() < NEGLIGIBLE:
        return np.ones(need.shape)
    # 1 - e^z - sum_j a_j e^(n_j z) falls ever faster with z = ln(X_s/X): Newton's method, begun
    # where no term exceeds 1, comes down to the root.
    order = np.where(n > 0.0, n, 1.0)
    z = -(functions.log(np.maximum(need, 1.0)) / order).max(axis=-1, keepdims=True)
    for _ in range(NEWTON_STEPS):
        rest, used = functions.exp(z), need * functions.exp(order * z)
        slope = rest + (order * used).sum(axis=-1, keepdims=True)
        z = z + (1.0 - rest - used.sum(axis=-1, keepdims=True)) / slope
    return np.asarray(functions.exp(n * z))
