"""Properties of temperature in the forms that other programs have."""

from typing import NamedTuple

import numpy as np

from pyrofit.numerics import fitting, functions
from pyrofit.solver.arrays import TABLE_TEMPERATURES_K, FloatArray
from pyrofit_exchange.fds.remarks import Remark

FROM_K, TO_K = 290.0, 800.0
"""Temperatures at which a property is followed."""
EXACT = 1e-6


class FittedForm(NamedTuple):
    """Coefficients of a form, and the largest relative error between `FROM_K` and `TO_K`."""

    coefficients: tuple[float, ...]
    error: float


def _part(table: FloatArray) -> tuple[FloatArray, FloatArray]:
    T = TABLE_TEMPERATURES_K
    kept = (T >= FROM_K) & (T <= TO_K)
    return T[kept], np.broadcast_to(table, T.shape)[kept]


def power_law(table: FloatArray, reference_K: float) -> FittedForm:
    """Return p0 and n of p = p0 (T/T_ref)^n, fitted to a property at the solver's nodes.

    >>> power_law(np.array([2.0]), 300.0).coefficients
    (2.0, 0.0)
    """
    T, p = _part(table)
    if np.ptp(p) <= EXACT * abs(float(p[0])):
        return FittedForm((float(p[0]), 0.0), 0.0)
    n, log_p0 = fitting.polynomial(functions.log(T / reference_K), functions.log(p), 1)
    fitted = functions.exp(log_p0) * functions.power(T / reference_K, n)
    return FittedForm(
        (float(functions.exp(log_p0)), float(n)), float(np.abs(fitted / p - 1.0).max())
    )


def quadratic(table: FloatArray) -> FittedForm:
    """Return p0, p1, p2 of p = p0 + p1 T + p2 T^2, a straight line where that is enough.

    >>> quadratic(np.array([2.0])).coefficients
    (2.0, 0.0, 0.0)
    """
    T, p = _part(table)
    if np.ptp(p) <= EXACT * abs(float(p[0])):
        return FittedForm((float(p[0]), 0.0, 0.0), 0.0)
    for degree in (1, 2):
        c = fitting.polynomial(T, p, degree)[::-1]
        error = float(np.abs(np.polynomial.polynomial.polyval(T, c) / p - 1.0).max())
        if error <= EXACT:
            break
    return FittedForm((*map(float, c), *[0.0] * (2 - degree)), error)


def remark_on(form: FittedForm, what: str, words: str) -> list[Remark]:
    """Return the remark on a form that is not exact."""
    if form.error <= 1e-4:
        return []
    how = f"{words}, off by {100.0 * form.error:.2g} % at most from {FROM_K:g} to {TO_K:g} K"
    return [Remark("approximate", what, how)]
