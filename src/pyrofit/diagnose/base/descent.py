"""The descent of a model on trial, by the least squares of all fits."""

from dataclasses import replace
from functools import partial

from pyrofit.diagnose.base.journal import name_of_descent
from pyrofit.diagnose.base.model import Model
from pyrofit.estimate.bounded_least_squares import Fit, minimise
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray

__all__ = ["Fit", "descend_chi_square", "refreshed"]


def descend_chi_square(
    model: Model,
    x: FloatArray,
    jacobian: FloatArray | None = None,
    enough: float | None = None,
    fixed: int | None = None,
    known: Fit | None = None,
) -> Fit:
    """Minimise chi-square from x, with derivatives to begin with if some are at hand.

    It ends where fresh ones promise less than ``enough``, by default as the settings say, or where
    it leads to a fit that is ``known``. The parameter at position ``fixed`` keeps its value.
    Parameters that no run uses, as those of an experiment left out, take their known values.
    """
    settings = model.base.settings
    enough = settings.converged_gain if enough is None else enough
    start = model.with_idle_known(x, fixed)

    def made() -> Fit:
        return minimise(
            model.residuals,
            model.jacobian,
            start,
            enough,
            begin=jacobian,
            fixed=fixed,
            idle=model.idle,
            known=known,
            most_steps=settings.most_steps,
            first_radius=settings.first_radius,
            ridge=settings.ridge,
        )

    journal = model.base.journal
    if journal is None:
        return made()
    asked = (jacobian, enough, fixed, known, model.names, model.idle, settings)
    name = name_of_descent(model.residuals_all, start, *asked)
    return journal.fit(name, made, partial(_fit_at, model, fixed))


def _fit_at(model: Model, fixed: int | None, x: FloatArray) -> Fit:
    """Return the fit that a descent to x ends with."""
    residuals = model.residuals(x)
    jacobian = model.jacobian(x, residuals)
    if fixed is not None:
        jacobian[:, fixed] = 0.0
    return Fit(linear.dot(residuals, residuals), x, residuals, jacobian)


def refreshed(model: Model, fit: Fit) -> Fit:
    """Return a fit with derivatives made at its end."""
    if fit.fresh:
        return fit
    return replace(fit, slopes=model.jacobian(fit.x, fit.residuals), fresh=True)
