"""The best fit to all data that are fitted, kinetics included."""

import numpy as np

from pyrofit.config import Study
from pyrofit.config.expand.programs import externals
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base, model_of
from pyrofit.errors import StudyError
from pyrofit.estimate.bounded_least_squares import Fit
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.pose import of_both
from pyrofit.experiments.external.simulate import OWN_MODEL
from pyrofit.results.files import Results, read_csv
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.stages.imp_likelihood import imp_likelihood


def best_fit(study: Study, results: Results) -> FittedModel:
    """Return the best fit to all fitted data: kinetics too, where they are fitted.

    Raises
    ------
    DataError
        The estimates are missing.
    StudyError
        An external program simulates a fitted experiment.
    """
    estimates = read_csv(
        results.identification("estimate.csv"),
        {"parameter": object, "estimate": float},
        {("parameter",): [(name,) for name in study.imp.estimate]},
    ).set_index("parameter")["estimate"]
    likelihood = _likelihood(study, results)
    values = {
        **fixed_for_imp(study, results),
        **{str(name): float(value) for name, value in estimates.items()},
    }
    start = likelihood.scaled(np.array([values[name] for name in likelihood.problem.names]))
    end = likelihood.descend(start)
    jacobian = likelihood.jacobian(end.x, end.residuals)
    base = Base(likelihood, tuple(range(len(likelihood.noise))))
    return FittedModel(model_of(base, {}), Fit(end.chi2, end.x, end.residuals, jacobian))


def _likelihood(study: Study, results: Results) -> Likelihood:
    """Return the likelihood of all fitted data."""
    asked = of_both(study)
    outside = {term.experiment for term in asked.terms} & set(externals(study))
    if outside:
        raise StudyError(f"experiments.{min(outside)}: {OWN_MODEL}")
    return imp_likelihood(study, results, asked)
