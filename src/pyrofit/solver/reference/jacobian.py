"""The Jacobian of a system whose unknowns act on their neighbours alone."""

from collections.abc import Callable

import numpy as np

from pyrofit.solver.arrays import FloatArray


def banded_jacobian(
    derivative: Callable[[FloatArray], FloatArray], y: FloatArray, change: FloatArray, half: int
) -> FloatArray:
    """Return d(dy/dt)/dy by differences, in packed form.

    Row u + i - j of column j holds element (i, j), u = ``half`` the half width of the band.
    Columns that have no row in common are changed together.

    Parameters
    ----------
    derivative : dy/dt of states of shape (..., size).
    y, change : the state, and the difference of each unknown, shape (size,).

    >>> banded_jacobian(lambda y: 2.0 * y, np.zeros(4), np.ones(4), 1)[1]
    array([2., 2., 2., 2.])
    """
    size, groups = y.size, 2 * half + 1
    columns = np.arange(size)
    states = np.tile(y, (groups, 1))
    states[columns % groups, columns] += change
    moved = derivative(states) - derivative(y)
    packed = np.zeros((groups, size))
    for off in range(-half, half + 1):
        j = columns[max(0, -off) : size - max(0, off)]
        packed[half + off, j] = moved[j % groups, j + off] / change[j]
    return packed
