"""A caller's function as a cost."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from pyrofit.cost import Term
from pyrofit.errors import StudyError
from pyrofit.solver.arrays import FloatArray

OwnCost = Callable[[FloatArray, FloatArray], Any]
"""From measured and simulated values of a signal, shape (points,), to residuals or a cost."""


def own_term(cost: OwnCost, name: str, term: Term) -> Term:
    """Return a term whose residuals are those of a caller's function.

    Raises
    ------
    StudyError
        The function returns neither residuals nor a cost for the measured values themselves.
    """
    measured = term.target.value
    found = _residuals(cost, name, measured, measured)
    if not np.isfinite(found).all():
        raise _refused(name, "a value that is not finite where both are equal")

    def residuals(cost: OwnCost, size: int, simulated: FloatArray) -> FloatArray:
        again = _residuals(cost, name, measured, simulated)
        if again.size != size:
            raise _refused(name, f"{again.size} residuals, and {size} before")
        return again

    return Term(name, term.target, {}, partial(residuals, cost, found.size))


def _residuals(cost: OwnCost, name: str, measured: FloatArray, simulated: FloatArray) -> FloatArray:
    """Return the residuals of a caller's function, or its cost as the only one, shape (size,)."""
    try:
        found = np.asarray(cost(measured, simulated), dtype=float)
    except Exception as error:
        raise StudyError(
            f"cost: {name}(measured, simulated) fails for arrays of the shape {measured.shape}: "
            f"{type(error).__name__}: {error}"
        ) from error
    if found.ndim > 1:
        raise _refused(name, f"an array of the shape {found.shape}")
    if found.ndim == 0 and found < 0.0:
        raise _refused(name, f"the negative cost {found:g}")
    return np.atleast_1d(found)


def _refused(name: str, found: str) -> StudyError:
    return StudyError(
        f"cost: {name}(measured, simulated) returns {found}; return residuals, always as many, or "
        "a cost that is not negative"
    )
