"""The likelihood of the inverse modelling, the same for all steps behind the searches."""

from collections.abc import Iterator

from pyrofit.config import Study
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.estimate.pose import Estimation
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.results import searches
from pyrofit.results.files import Results
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.results.recorded import load


def imp_likelihood(
    study: Study, results: Results, estimation: Estimation, searched: bool = True
) -> Likelihood:
    """Return the likelihood of the inverse modelling, or of the kinetics too.

    If a signal jumps, or is recorded against temperature, its noise depends on the ends of the
    searches. Every step takes it about the same set of them, so that all have the same
    chi-square. Only steps before the searches take it about smooth curves (not ``searched``).

    Raises
    ------
    DataError
        A signal jumps and a search has not run, or a channel is too short to show its noise.
    """
    measurements, fixed = load(study, results), fixed_for_imp(study, results)
    fits = ends_of_searches(study, results) if searched else ()
    return pose_likelihood(study, estimation, measurements, fixed, fits)


def ends_of_searches(study: Study, results: Results) -> Iterator[dict[str, float]]:
    """Yield the ends of all searches by name, SI units: of every start and every repetition.

    Raises
    ------
    DataError
        A search has not run.
    """
    names = list(study.imp.estimate)
    for cost in study.imp.costs:
        for optimiser in OPTIMISERS:
            for start in searches.read_starts(study, results, cost, optimiser):
                yield {name: start.parameters[name] for name in names}
    for values in searches.best_of_repetitions(study, results)[names].to_numpy(float).tolist():
        yield dict(zip(names, values, strict=True))
