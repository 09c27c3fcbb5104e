"""Gpyro's objective function, turned so that lower is better."""

from functools import partial

import numpy as np

from pyrofit.cost.target import FloatArray, Residuals, Target, number
from pyrofit.numerics import functions


def gpyro(
    target: Target, *, eps: float = 0.1, zeta: float = 2.0, reference: float = 0.0
) -> Residuals:
    """Gpyro's objective: 1 - eps^zeta mean((|y| / (|model - y| + eps |y|))^zeta).

    Gpyro maximises, over the times of a curve,

        F = mean((|y| / (|model - y| + eps |y|))^zeta),

    which is at most eps^-zeta. The cost is 1 - eps^zeta F: 0 for a model that meets every
    point, below 1 for all others that come near one. Costs of several signals add up as Gpyro's
    fitnesses do. Where y = 0, a model that is 0 meets the point, and any other misses it in full.

    Parameters
    ----------
    target : Target
        The target y, n points.
    eps : float
        Relative difference [-], above 0, at which a point has lost 1 - 2^-zeta of its fitness.
        Gpyro's default is 0.01; UCB's entry to MaCFP-4 used 0.1.
    zeta : float
        Exponent [-], above 0; 2 in Gpyro and in UCB's entry.
    reference : float
        Level in the unit of y from which y and model are counted. Gpyro counts temperatures from
        the initial temperature, all else from 0.

    Returns
    -------
    function from array, shape (n,), to array, shape (n,)
        Residuals of a model at the target's times [-], with the sign of the difference; their
        norm is the cost.

    Raises
    ------
    CostError
        An option is not finite, or eps or zeta is not above 0.

    References
    ----------
    Lautenberger, Gpyro, ``GA%FIT`` in ``src/propest/propest_subs.f90`` (lautenberger/gpyro on
    GitHub). UCB's values: README of ``Wood/Calibration_Results/UCB`` in the MaCFP data base.

    Examples
    --------
    >>> residuals = gpyro(Target([0, 1], [2, 2]), eps=0.5)
    >>> float(np.linalg.norm(residuals(np.array([2.0, 3.0]))))  # (0 + 1 - 0.25) / 2
    0.375
    """
    eps, zeta = number("eps", eps, above=0.0), number("zeta", zeta, above=0.0)
    size = np.abs(target.value - number("reference", reference))
    return partial(_lost, target.value, size, eps, zeta)


def _lost(
    value: FloatArray, size: FloatArray, eps: float, zeta: float, model: FloatArray
) -> FloatArray:
    if not np.isfinite(model).all():
        return np.full(model.shape, np.inf)
    difference = model - value
    allowed = eps * size
    away = allowed + np.abs(difference)
    reached = np.divide(allowed, away, out=np.ones_like(away), where=away > 0.0)
    # The usual exponent is a product; a power takes longer.
    kept = reached * reached if zeta == 2.0 else functions.power(reached, zeta)
    lost = 1.0 - kept
    # The norm of these is the mean of the losses: the fitnesses add up, not their squares.
    return np.asarray(np.sign(difference) * np.sqrt(lost * lost.mean() / lost.size))
