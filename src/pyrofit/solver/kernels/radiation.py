"""How cells absorb and emit radiation."""

import math

from pyrofit.compiled.jit import inner, live
from pyrofit.solver.kernels.functions import exp
from pyrofit.solver.kernels.lanes import opposite, somewhere, where
from pyrofit.solver.kernels.reactions import TINY
from pyrofit.solver.kernels.tables import at_place, place_of

LEAST_DEPTH = 1.0e-9
"""Depth [m] from which a surface radiates at least."""


@inner
def optical_depth(m, n, material, T):
    """Return kappa d [-] of cell n at T, the absorption coefficient mixed by volume."""
    place = place_of(T)
    optical = 0.0 * m[0, n]
    absorption = optical
    of = -1
    for i in range(m.shape[0]):
        if material.alike[i] != of:
            of = material.alike[i]
            absorption = at_place(material.absorption, of, place, material.constant[i])
        optical += m[i, n] * material.specific_volume[i] * absorption
    return optical


@inner
def is_opaque(material):
    """Tell whether all components absorb at the surface."""
    opaque = material.absorption[0, 0] <= 0.0
    for i in range(1, material.absorption.shape[0]):
        opaque = opaque & (material.absorption[i, 0] <= 0.0)
    return opaque


@inner
def mean_depth(optical):
    """Return the mean depth at which a layer absorbs over its thickness, 1/tau - 1/(e^tau - 1)."""
    tau = max(optical, 1e-2)
    return where(optical < 1e-2, 0.5 - optical / 12.0, 1.0 / tau - 1.0 / (exp(tau) - 1.0))


@inner
def emitting_layer(m, n, material):
    """Return thickness d [m] and eps d [m] of cell n, the emissivity mixed by volume."""
    d = 0.0 * m[0, n]
    e = 0.0 * m[0, n]
    for i in range(m.shape[0]):
        v = m[i, n] * material.specific_volume[i]
        d += v
        e += v * material.emissivity[i]
    return d, e


@inner
def differ(m, n, material):
    """Tell whether the components of cell n and of the next one differ in emissivity."""
    lowest = math.inf + 0.0 * m[0, n]
    highest = -lowest
    for i in range(m.shape[0]):
        e = material.emissivity[i]
        there = m[i, n] + m[i, n + 1] > 0.0
        lowest = where(there, min(lowest, e), lowest)
        highest = where(there, max(highest, e), highest)
    return highest > lowest


@inner
def emissivity_of_top(part, m, n, material):
    """Return the emissivity of the topmost ``part`` [m] of cell n.

    The volume fractions are linear over the depth, with the means of this cell and the next one.
    Those below zero are set to zero.
    """
    d, _ = emitting_layer(m, n, material)
    d_below, _ = emitting_layer(m, n + 1, material)
    ahead = (d - part) / max(d + d_below, TINY)
    volume = 0.0 * d
    shine = 0.0 * d
    for i in range(m.shape[0]):
        own = m[i, n] * material.specific_volume[i] / max(d, TINY)
        below = m[i, n + 1] * material.specific_volume[i] / max(d_below, TINY)
        fraction = max(own + ahead * (own - below), 0.0)
        volume += fraction
        shine += fraction * material.emissivity[i]
    return shine / max(volume, TINY)


@inner
def top_emissivity(depth, skin, m, first, material, before):
    """Return the volume-averaged emissivity of the top ``depth`` of the current sample.

    A sample that has vanished keeps the value it had ``before``.
    """
    depth = max(depth, LEAST_DEPTH)
    z, total = emitting_layer(skin, 0, material)
    found = z >= depth
    eps = where(found, total / max(z, TINY), before)
    for n in live(m, first):
        if not somewhere(opposite(found)):
            return eps
        d, e = emitting_layer(m, n, material)
        here = opposite(found) & (d >= depth - z)
        part = depth - z
        shine = part / max(d, TINY) * e
        if n + 1 < m.shape[1]:
            varies = here & differ(m, n, material)
            if somewhere(varies):
                shine = where(varies, part * emissivity_of_top(part, m, n, material), shine)
        eps = where(here, (total + shine) / depth, eps)
        found = found | here
        total += e
        z += d
    return where(opposite(found) & (z > 0.0), total / max(z, TINY), eps)
