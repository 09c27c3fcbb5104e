"""The costs of `which_cost.py`, as optimisers search them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from which_cost_cases import SIGNALS, Posed

from pyrofit.config import TermSpec
from pyrofit.cost import WeightedSum
from pyrofit.cost.term import Term
from pyrofit.estimate.likelihood import Likelihood, likelihood_of
from pyrofit.estimate.measures import measures_of
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.prior import within_known
from pyrofit.estimate.problem import Problem, make_problem
from pyrofit.solver.arrays import FloatArray

SUMS: dict[str, tuple[str, ...]] = {
    "THR": ("THR_above", "THR_below"),
    "NRSE+THR": ("NRSE", "THR_above", "THR_below"),
    "RMSE+NRSE+THR": ("RMSE_mean", "NRSE", "THR_above", "THR_below"),
}
"""Eq. 5 with all weights 1."""
OF_RATE: dict[str, tuple[str, ...]] = {
    "RMSE": ("RMSE_mean",),
    "RANGE": ("RANGE_printed",),
    "RANGE_PROPTI": ("RANGE_PROPTI",),
    "BANDS": ("BANDS_printed",),
    "BANDS_PROPTI": ("BANDS_PROPTI",),
    "GPYRO": ("GPYRO",),
    "NRSE": ("NRSE",),
    **SUMS,
}
"""Costs of the rate alone, by the names of `pyrofit rescore` that they are made of."""
OF_BOTH: dict[str, tuple[str, ...]] = {"NRMS_all": ("NRMS_all",), "GPYRO_all": ("GPYRO_all",)}
"""Costs of rate and back temperature."""
LIKELIHOODS = {"chi2": SIGNALS[:1], "chi2_all": SIGNALS}
COSTS = (*OF_RATE, "chi2", *OF_BOTH, "chi2_all")
CLOSE = 0.01
"""A search has found the least cost if it ends above it by less than this share; a sum of squares
by twice that, a cost that can be zero by 1e-4."""


class SumOfSquares(WeightedSum):
    """The sum of the squares of the costs: chi-square where residuals are whitened."""

    def parts(self, models: Sequence[FloatArray]) -> list[float]:
        """Give the squares."""
        return [part**2 for part in super().parts(models)]


@dataclass(frozen=True)
class Fitted:
    """A cost on a case.

    Parameters
    ----------
    name
        Name of the cost.
    problem
        The problem that optimisers minimise.
    likelihood
        The likelihood whose intervals belong to it, if there is one.
    """

    name: str
    problem: Problem
    likelihood: Likelihood | None = None

    @property
    def close(self) -> float:
        """How far above the least value a search may end."""
        return CLOSE * (2.0 if isinstance(self.problem.cost, SumOfSquares) else 1.0)


def fitted(of: Posed, name: str, accuracy: dict[str, Any]) -> Fitted:
    """Return a cost as optimisers search it."""
    study, series = of.study, of.series
    if name in LIKELIHOODS:
        terms = [TermSpec(experiment=of.fitted, signal=s, kind="RMSE") for s in LIKELIHOODS[name]]
    else:
        names = {**OF_RATE, **OF_BOTH}[name]
        terms = [t for m in measures_of(study, series, names)[0] for t in m.terms]
    material = study.material_with(study.imp.kinetics)
    made = make_problem(study, study.imp.estimate, terms, series, material, of.fixed)
    problem = replace(
        within_known(study, made), accuracy=study.accuracy.model_copy(update=accuracy)
    )
    if name not in LIKELIHOODS:
        return Fitted(name, problem)
    likelihood = likelihood_of(problem)
    return Fitted(name, replace(problem, cost=_chi2(likelihood)), likelihood)


def _chi2(likelihood: Likelihood) -> SumOfSquares:
    """Return chi-square as a cost."""
    terms = []
    for noise, (_, term) in zip(likelihood.noise, likelihood.problem.cost.terms, strict=True):
        residuals = partial(_whitened, noise, term.target.value)
        terms.append((1.0, Term("chi2", term.target, {}, residuals)))
    return SumOfSquares(terms)


def _whitened(noise: NoiseModel, value: FloatArray, model: FloatArray) -> FloatArray:
    return noise.whiten(model - value)
