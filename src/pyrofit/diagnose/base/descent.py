"""Least squares from a start: Levenberg and Marquardt with Broyden's updates, within limits.

Marquardt (1963, doi 10.1137/0111030); Broyden (1965, doi 10.1090/S0025-5718-1965-0198670-6). A
step costs one simulation instead of one per parameter; the derivatives are made anew where the
updated ones lead nowhere.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear

from pyrofit.diagnose.base.model import Model
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Fit:
    """Where a descent ended: chi-square, x, whitened residuals and their derivatives there.

    chi2 counts what is known; ``jacobian`` has shape (points + known, parameters) and is exact at x
    only where it is ``fresh``.
    """

    chi2: float
    x: FloatArray
    residuals: FloatArray
    jacobian: FloatArray
    fresh: bool = True


def descend(
    model: Model,
    x: FloatArray,
    jacobian: FloatArray | None = None,
    enough: float = SETTINGS.converged_gain,
    fixed: int | None = None,
) -> Fit:
    """Minimise chi-square from x, with derivatives to begin with if some are at hand.

    It ends where fresh derivatives promise less than ``enough``. The parameter at position
    ``fixed`` keeps its value.
    """
    x = np.clip(x, 0.0, 1.0)
    r = model.residuals(x)
    fresh = jacobian is None
    held = [] if fixed is None else [fixed]
    J = _without(held, model.jacobian(x, r)) if jacobian is None else jacobian
    damping, refused = 1e-3, 0
    for _ in range(SETTINGS.most_steps):
        step, promised = _step(J, r, x, damping)
        step[held] = 0.0
        gained = -1.0
        if promised > enough:
            ahead = np.clip(x + step, 0.0, 1.0)  # a rate rounded below zero is no rate
            there = model.residuals(ahead)
            gained = float(r @ r - there @ there)
        if gained > 0.0:
            J = J + np.outer(there - r - J @ step, step) / (step @ step)
            x, r, fresh, refused = ahead, there, False, 0
            damping = max(damping * (0.2 if gained > 0.5 * promised else 1.0), 1e-6)
        if gained > enough:
            continue
        if not fresh:
            J, fresh = _without(held, model.jacobian(x, r)), True
        elif promised <= enough or refused == SETTINGS.most_refused:
            break
        else:
            damping, refused = 10.0 * damping, refused + 1
    return Fit(float(r @ r), x, r, J, fresh)


def _without(held: list[int], jacobian: FloatArray) -> FloatArray:
    """Return derivatives by which parameters that are held change nothing."""
    jacobian[:, held] = 0.0
    return jacobian


def refreshed(model: Model, fit: Fit) -> Fit:
    """Return a fit with derivatives made at its end, where it has updated ones."""
    return (
        fit
        if fit.fresh
        else replace(fit, jacobian=model.jacobian(fit.x, fit.residuals), fresh=True)
    )


def _step(J: FloatArray, r: FloatArray, x: FloatArray, damping: float) -> tuple[FloatArray, float]:
    """Return the best damped step within the limits, and the fall of chi-square it promises.

    The least of 2 g^T s + s^T (J^T J + D) s for limits of s (Stark and Parker 1995, Comput. Stat.
    10, 129): a step that is cut off at the limits one by one may promise next to nothing.
    """
    bend, slope = J.T @ J, J.T @ r
    R = np.linalg.cholesky(bend + np.diag(damping * np.diag(bend) + SETTINGS.ridge)).T
    best = lsq_linear(
        R, -np.linalg.solve(R.T, slope), (-x, 1.0 - x), method="bvls", max_iter=10 * x.size
    )
    step = np.asarray(best.x)
    return step, -float(2.0 * slope @ step + step @ bend @ step)
