"""How functions are compiled."""

import numpy as np
from numba import njit

from pyrofit.compiled.cache import CompiledFiles


def entry(function, told=True):
    """For functions called from Python; kept on disk by a cache of our own."""
    compiled = njit(error_model="numpy", no_cfunc_wrapper=True, nogil=True)(function)
    compiled._cache = CompiledFiles(function, told)  # where `cache=True` puts that of numba
    return compiled


def short(function):
    """For those that are compiled in a second or two, which nobody need be told."""
    return entry(function, told=False)


making = njit(error_model="numpy", no_cfunc_wrapper=True, no_cpython_wrapper=True)
"""For functions that these call and that make arrays, or return views of them."""

inner = njit(
    error_model="numpy",
    forceinline=True,
    _nrt=False,
    no_cfunc_wrapper=True,
    no_cpython_wrapper=True,
)
"""For the functions that these call, compiled into the caller.

Without the private `_nrt=False` numba counts references, atomically, at every access to an array
held in a tuple: more than half of the time of a run. Such functions must not make arrays.
"""

loop = njit(error_model="numpy", _nrt=False, no_cfunc_wrapper=True, no_cpython_wrapper=True)
"""The same for long functions, not compiled into every caller."""


@inner
def live(array, first):
    """Return the columns of an array from the first on.

    They are unsigned: a signed index could count from the end, and its loop is not vectorised.
    """
    return range(np.uint32(first), np.uint32(array.shape[1]))


@inner
def between(first, behind):
    """Return the same from the first up to the one behind the last."""
    return range(np.uint32(first), np.uint32(behind))
