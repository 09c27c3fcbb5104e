"""Known values of parameters, as rows of residuals or as limits of a search."""

from dataclasses import dataclass, field, replace

import numpy as np

from pyrofit.config import Study
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class NormalPrior:
    """Known values: positions of parameters, mean and sd in SI units, shape (known,).

    Its -2 log density is |r|^2 + constant, r = (x - mean) / sd.
    """

    index: tuple[int, ...]
    mean: FloatArray
    sd: FloatArray
    weight: FloatArray = field(default_factory=lambda: np.ones(()))
    """Divisor of the standard deviations, see `over`; one number or shape (known,)."""

    def residuals(self, values: FloatArray) -> FloatArray:
        """Return r of parameter sets in SI units: (sets, parameters) to (sets, known)."""
        return np.asarray((values[:, list(self.index)] - self.mean) / self.sd)

    def slopes(self, span: FloatArray) -> FloatArray:
        """Return d r / d x, shape (known, parameters), x in units of ``span``, SI."""
        rows = np.zeros((len(self.index), span.size))
        rows[np.arange(len(self.index)), list(self.index)] = span[list(self.index)] / self.sd
        return rows

    def stated_slopes(self, span: FloatArray) -> FloatArray:
        """Return d r / d x with the stated standard deviations."""
        return np.asarray(self.slopes(span).T / self.weight).T

    def over(self, factor: float | FloatArray) -> "NormalPrior":
        """Return this knowledge with its standard deviations divided by a factor."""
        return replace(self, sd=self.sd / factor, weight=np.asarray(self.weight * factor))

    @property
    def heaviest(self) -> float:
        """The largest weight, 1 where nothing is known."""
        return float(np.max(self.weight, initial=1.0))


NO_PRIOR = NormalPrior((), np.empty(0), np.empty(0))
"""Nothing is known but the limits."""


def prior_of(study: Study, problem: Problem) -> NormalPrior:
    """Return the known values of the parameters that a problem estimates."""
    found = {name: known for name, known in study.known.items() if name in problem.names}
    factors = {name: study.parameters[name].factor for name in found}
    return NormalPrior(
        tuple(problem.names.index(name) for name in found),
        np.array([known.value * factors[name] for name, known in found.items()]),
        np.array([known.sd * factors[name] for name, known in found.items()]),
    )


def within_known(study: Study, problem: Problem) -> Problem:
    """Return the problem with the limits of known values, three standard deviations by default.

    Thousands of correlated points of an inexact model cannot overrule an independent measurement.
    A cost, which has no term for known values, keeps them as well.
    """
    limits = np.array([study.search_limits(name) for name in problem.names])
    factors = np.array([study.parameters[name].factor for name in problem.names])
    return replace(problem, lower=limits[:, 0] * factors, upper=limits[:, 1] * factors)
