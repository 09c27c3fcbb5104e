"""Emission of radiation by elements, and absorption of the radiation that enters a sample."""

import numpy as np

from pyrofit.numerics import functions, linear
from pyrofit.solver.arrays import FloatArray

LEAST_DEPTH = 1e-9
"""Depth [m] from which a surface radiates at least."""


def top_average(volume: FloatArray, emissivity: FloatArray, depth: float) -> float:
    """Return the emissivity averaged over the top ``depth`` [m] of a sample, or all of it.

    ``volume`` [m], shape (elements, components), is that of the elements, front first. Volume
    fractions are linear through the means of the element that ends the depth and the next one.
    """
    d = volume.sum(axis=-1)
    below = np.concatenate(([0.0], np.cumsum(d)))
    to = min(max(depth, LEAST_DEPTH), below[-1])
    k = int(np.searchsorted(below, to)) - 1
    part, fraction = to - below[k], volume[k] / d[k]
    if k + 1 < d.size and d[k + 1] > 0.0:
        rise = fraction - volume[k + 1] / d[k + 1]
        fraction = np.maximum(fraction + rise * (d[k] - part) / (d[k] + d[k + 1]), 0.0)
    total = volume[:k].sum(axis=0) + part * fraction / fraction.sum()
    return float(linear.product(total, emissivity) / to)


def absorbed(radiation: float, tau: FloatArray) -> tuple[FloatArray, float]:
    """Return the radiation [W/m2] that each node absorbs, shape (elements + 1,), and that passing.

    Elements have the optical depths ``tau``, shape (elements,). The radiation that one absorbs
    goes to its nodes by their shape functions: 1/tau - 1/(e^tau - 1) of it to the lower one.
    """
    reaching = radiation * functions.exp(-np.concatenate(([0.0], np.cumsum(tau))))
    lost = reaching[:-1] - reaching[1:]
    thick = np.maximum(tau, 1e-2)
    lower = np.where(
        tau < 1e-2,
        0.5 - tau / 12.0 + tau * tau * tau / 720.0,
        1.0 / thick - 1.0 / (functions.exp(thick) - 1.0),
    )
    out = np.zeros(tau.size + 1)
    out[:-1] = (1.0 - lower) * lost
    out[1:] += lower * lost
    return out, float(reaching[-1])
