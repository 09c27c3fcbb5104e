"""The floating-point rate of a plain loop of fused multiply-adds in the kernels' registers."""

import numpy as np
from case import seconds

from pyrofit.compiled.jit import entry
from pyrofit.solver.kernels.functions import fma
from pyrofit.solver.kernels.lanes import in_lanes
from pyrofit.solver.run import LANES

CHAINS = 12
"""Independent sums, enough to hide how long one addition takes."""
ROUNDS = 1_000_000


@entry
def multiply_add(width, numbers, rounds):
    """Multiply and add to each of twelve rows so many times; shape (12, lanes)."""
    rows = in_lanes(width, numbers)
    a, b, c, d, e, f = rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]
    g, h, i, j, k, m = rows[6], rows[7], rows[8], rows[9], rows[10], rows[11]
    x = 0.0 * a + 0.5
    for _ in range(rounds):
        a, b, c = fma(a, x, x), fma(b, x, x), fma(c, x, x)
        d, e, f = fma(d, x, x), fma(e, x, x), fma(f, x, x)
        g, h, i = fma(g, x, x), fma(h, x, x), fma(i, x, x)
        j, k, m = fma(j, x, x), fma(k, x, x), fma(m, x, x)
    rows[0], rows[1], rows[2], rows[3], rows[4], rows[5] = a, b, c, d, e, f
    rows[6], rows[7], rows[8], rows[9], rows[10], rows[11] = g, h, i, j, k, m


def flops_per_second() -> float:
    """Return the floating-point operations per second of one core."""
    numbers = np.random.default_rng(1).random((CHAINS, LANES))
    width = (0,) * LANES
    return 2.0 * CHAINS * LANES * ROUNDS / seconds(lambda: multiply_add(width, numbers, ROUNDS))
