"""Conversion: the share of the released mass that is released already."""

import numpy as np

from pyrofit.solver.arrays import FloatArray


def conversion(mass: FloatArray) -> FloatArray:
    """Return the released share of all that is released in the record, shape (n,).

    >>> conversion(np.array([1.0, 0.6, 0.2]))
    array([0. , 0.5, 1. ])
    """
    released = mass[0] - mass
    return np.asarray(released / max(float(released[-1]), 1e-12))
