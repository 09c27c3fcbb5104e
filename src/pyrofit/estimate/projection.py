"""The part of a change of the residuals that the fitted parameters cannot make up for."""

import numpy as np

from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


def projector(fit: Fit) -> FloatArray:
    """Return Q of the parameters of a fit; one that rests at a limit does not move."""
    slope = linear.product(fit.jacobian.T, fit.residuals)
    free = ~((fit.x <= 0.0) & (slope > 0.0)) & ~((fit.x >= 1.0) & (slope < 0.0))
    return spanned_by(fit.jacobian[:, free])


def spanned_by(J: FloatArray) -> FloatArray:
    """Return Q with P w = w - Q Q^T w, up to the limits: the span of the fitted parameters.

    ``J`` has the derivatives of the whitened residuals by the parameters that move.
    """
    U, s, _ = linear.svd(J)
    # w - J (J^T J + Pi)^-1 J^T w = w - U (s^2/(s^2 + Pi)) U^T w
    return np.asarray(U * np.sqrt(s**2 / (s**2 + UNIFORM)))


def project(spanned: FloatArray, w: FloatArray) -> FloatArray:
    """Return P w."""
    return np.asarray(w - linear.product(spanned, linear.product(spanned.T, w)))
