"""The systems (I - c J) x = b of an implicit step, eliminated in a fixed order."""

from typing import Any

import numpy as np

from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.reference.bdf import Solve


def slab_factor(packed: FloatArray, c: float) -> Solve:
    """Return a function that solves (I - c J) x = b for J of a slab.

    The extents of an element act on it and its two nodes alone. They are eliminated, which leaves
    three diagonals for the temperatures.

    Parameters
    ----------
    packed
        J as `banded_jacobian` packs it, half the width of the band its stride s; unknowns in the
        order T_0, xi_0j, T_1, ..., T_N with s - 1 extents each.
    """
    s = len(packed) // 2
    nodes = np.arange(0, packed.shape[1], s)
    extents = nodes[:-1, None] + np.arange(1, s)

    def part(rows: Any, columns: Any) -> FloatArray:
        return np.asarray(-c * packed[s + rows - columns, columns])

    near = np.stack([nodes[:-1], nodes[1:]], axis=1)
    own = inverses(np.eye(s - 1) + part(extents[:, :, None], extents[:, None, :]))
    by_heat = np.einsum("eij,ejk->eik", own, part(extents[:, :, None], near[:, None, :]))
    of_extents = part(near[:, :, None], extents[:, None, :])
    less = np.einsum("eij,ejk->eik", of_extents, by_heat)
    middle = 1.0 + part(nodes, nodes)
    middle[:-1] -= less[:, 0, 0]
    middle[1:] -= less[:, 1, 1]
    lower = part(nodes[1:], nodes[:-1]) - less[:, 1, 0]
    upper = part(nodes[:-1], nodes[1:]) - less[:, 0, 1]
    solve_heat = tridiagonal(lower, middle, upper)

    def solve(b: FloatArray) -> FloatArray:
        alone = np.einsum("eij,ej->ei", own, b[extents])
        moved = np.einsum("eij,ej->ei", of_extents, alone)
        heat = b[nodes]
        heat[:-1] -= moved[:, 0]
        heat[1:] -= moved[:, 1]
        x = np.empty(b.size)
        x[nodes] = solve_heat(heat)
        x[extents] = alone - np.einsum("eij,ej->ei", by_heat, x[near])
        return x

    return solve


def dense_factor(J: FloatArray, c: float) -> Solve:
    """Return a function that solves (I - c J) x = b for J of shape (n, n), n small."""
    own = inverses((np.eye(len(J)) - c * J)[None])[0]
    return lambda b: linear.product(own, b)


def inverses(a: FloatArray) -> FloatArray:
    """Return the inverses of small matrices side by side, shape (k, n, n), by Gauss and Jordan."""
    size = a.shape[1]
    both = np.concatenate([a, np.broadcast_to(np.eye(size), a.shape)], axis=2)
    for i in range(size):
        both[:, i] /= both[:, i, i, None].copy()
        for j in range(size):
            if j != i:
                both[:, j] -= both[:, j, i, None].copy() * both[:, i]
    return both[:, :, size:]


def tridiagonal(lower: FloatArray, middle: FloatArray, upper: FloatArray) -> Solve:
    """Return a function that solves a system of three diagonals, by Thomas's algorithm.

    Numbers of Python are faster here than arrays, as each row needs the one before.
    """
    above, pivots, shares = upper.tolist(), middle.tolist(), lower.tolist()
    for i, (below, beside) in enumerate(zip(lower.tolist(), above, strict=True)):
        shares[i] = below / pivots[i]
        pivots[i + 1] -= shares[i] * beside

    def solve(b: FloatArray) -> FloatArray:
        x = b.tolist()
        last = x[0]
        for i, share in enumerate(shares, start=1):
            last = x[i] = x[i] - share * last
        last = x[-1] = last / pivots[-1]
        for i in range(len(above) - 1, -1, -1):
            last = x[i] = (x[i] - above[i] * last) / pivots[i]
        return np.array(x)

    return solve
