"""Residuals and log-likelihood of a study as functions of a vector, for other optimisers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from pyrofit.api.choices import Signals
from pyrofit.api.measurements import Data, given_keys, read_measured
from pyrofit.api.studies import Source, read_study
from pyrofit.api.tasks import task_of, values_within
from pyrofit.api.weighing import Weights, weighted, weights_of
from pyrofit.config import Study
from pyrofit.errors import StudyError
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.numerics import linear
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class Objective:
    """A function of the estimated parameters, in the units of the study.

    Parameters
    ----------
    study
        The study.
    likelihood
        Its likelihood, in SI units.
    """

    study: Study
    likelihood: Likelihood
    words: ClassVar[str] = "function"
    """What it returns."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of a vector."""
        return self.likelihood.problem.names

    @property
    def limits(self) -> FloatArray:
        """Lower and upper limits in the units of the study, shape (parameters, 2)."""
        problem = self.likelihood.problem
        return np.column_stack([problem.lower, problem.upper]) / self._factors[:, None]

    def __repr__(self) -> str:
        """Return what it is a function of, for display."""
        units = (self.study.parameters[name].unit for name in self.names)
        rows = zip(self.names, self.limits, units, strict=True)
        lines = [f"{name}: {low:g} to {high:g} {unit}" for name, (low, high), unit in rows]
        return "\n  ".join([f"{self.words} of study '{self.study.name}'", *lines])

    @property
    def _factors(self) -> FloatArray:
        return np.array([self.study.parameters[name].factor for name in self.names])

    def _scaled(self, given: Any) -> FloatArray:
        """Return vectors as fractions of the search range, shape (sets, parameters)."""
        if isinstance(given, Mapping):
            if set(given) != set(self.names):
                raise StudyError(
                    f"values: {', '.join(map(str, given))} are given; give exactly "
                    f"{', '.join(self.names)}"
                )
            given = [given[name] for name in self.names]
        try:
            X = np.atleast_2d(np.asarray(given, dtype=float))
        except (TypeError, ValueError):
            raise StudyError(
                "values: numbers are needed, as a vector or by name: " + ", ".join(self.names)
            ) from None
        if X.ndim != 2 or X.shape[1] != len(self.names):
            raise StudyError(
                f"values: the shape is {np.shape(given)}; give {len(self.names)} numbers a set: "
                f"{', '.join(self.names)}"
            )
        problem = self.likelihood.problem
        return np.asarray((X * self._factors - problem.lower) / problem.span)


class Residuals(Objective):
    """Whitened residuals as a function, see `pyrofit.residuals`."""

    words = "residuals"

    def __call__(self, values: Any) -> FloatArray:
        """Return the residuals of a vector, shape (points + known,), or of each row of a table."""
        X = self._scaled(values)
        if not np.isfinite(X).all():
            raise StudyError("values: a number is not finite; give finite numbers")
        found = np.array(self.likelihood.residuals_all(X))
        return found if np.ndim(values) == 2 else found[0]


class LogLikelihood(Objective):
    """Log-likelihood as a function, see `pyrofit.log_likelihood`."""

    words = "log-likelihood"

    def __call__(self, values: Any) -> Any:
        """Return the log-likelihood of a vector, a float, or of each row of a table."""
        X = self._scaled(values)
        found = np.full(len(X), -np.inf)
        within = np.flatnonzero(((X >= 0.0) & (X <= 1.0)).all(axis=1))
        residuals = self.likelihood.residuals_all(X[within]) if within.size else []
        for i, r in zip(within, residuals, strict=True):
            if self.likelihood.finished(r):
                found[i] = -0.5 * linear.dot(r, r)
        return found if np.ndim(values) == 2 else float(found[0])


def residuals(
    study: Source,
    data: Data | None = None,
    *,
    signals: Signals | None = None,
    estimate: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    weights: Weights | None = None,
    about: Mapping[str, float] | None = None,
) -> Residuals:
    """Return the residuals that `fit` minimises, as a function for other optimisers.

    r = L^-1 (model(x) - y) / sd of each signal, with noise of standard deviation sd and
    correlation L L^T, then (x_k - mean_k) / sd_k of known values.

    Parameters
    ----------
    study, data, signals, estimate, fixed, weights
        As of `fit`.
    about
        A set that fits well, such as ``fit.values``: signals that jump, or are recorded against
        temperature, have their noise about its curves, as in `fit`. By default it is about a
        smooth curve through the record.

    Returns
    -------
    Residuals
        A function of a vector, or of values by name, in the units of the study. It returns an
        array of the shape (points + known,). A table of the shape (sets, parameters) gives one of
        (sets, points + known), from simulations side by side. A run that does not finish has
        residuals of 1e4. ``names`` and ``limits`` describe the vector.

    Raises
    ------
    StudyError
        A name is not known, or a parameter has no limits or no value, or ``about`` lacks one. The
        function raises it for values of a wrong shape or kind.
    DataError
        A measured series is missing, breaks a rule, or is too short to show its noise.
    """
    return Residuals(*_posed(study, data, signals, estimate, fixed, weights, about))


def log_likelihood(
    study: Source,
    data: Data | None = None,
    *,
    signals: Signals | None = None,
    estimate: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    weights: Weights | None = None,
    about: Mapping[str, float] | None = None,
) -> LogLikelihood:
    """Return the log-likelihood of a study as a function, for samplers.

    It is ``-|r|^2 / 2`` with the residuals r of `residuals`, up to a constant. It is -inf outside
    the limits, for numbers that are not finite, and where a run does not finish. Parameters and
    other errors are those of `residuals`. Where the model misses the tests, it is no measure of the
    uncertainty: `fit` then takes plain least squares, with intervals that include the misfit.

    Returns
    -------
    LogLikelihood
        A function of a vector, or of values by name, in the units of the study. It returns a
        float; for a table of the shape (sets, parameters) an array of the shape (sets,).
    """
    return LogLikelihood(*_posed(study, data, signals, estimate, fixed, weights, about))


def _posed(
    study: Source,
    data: Data | None,
    signals: Signals | None,
    estimate: Sequence[str] | None,
    fixed: Mapping[str, float] | None,
    weights: Weights | None,
    about: Mapping[str, float] | None,
) -> tuple[Study, Likelihood]:
    """Return the study, and the likelihood that `fit` poses."""
    study = read_study(study)
    values = values_within(study, "fixed", fixed)
    task = task_of(study, signals, estimate, values, None, given_keys(study, data))
    own_weights = weights_of(study, task.keys, weights)
    series = read_measured(study, task.keys, data)
    asked = of_diagnosis(study, task.channels, task.estimate)
    fits = [] if about is None else [_set(study, asked.names, about)]
    return study, weighted(pose_likelihood(study, asked, series, task.fixed, fits), own_weights)


def _set(study: Study, names: Sequence[str], about: Mapping[str, float]) -> dict[str, float]:
    """Return the SI values of a set that holds all estimated parameters."""
    values = values_within(study, "about", about)
    missing = [name for name in names if name not in values]
    if missing:
        raise StudyError(f"about: there is no value of {', '.join(missing)}; give a whole set")
    return values
