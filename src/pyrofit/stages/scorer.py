"""All costs at once: a set is simulated once, and scored by each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.config import Study, TermSpec
from pyrofit.errors import DataError
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.measures import LIKELIHOOD, Measure
from pyrofit.estimate.pose import of_imp, pose
from pyrofit.estimate.problem import Outcome, Problem
from pyrofit.estimate.targets import Measurements
from pyrofit.numerics import linear
from pyrofit.parallel import MOST_PIECES, parallel_map
from pyrofit.results.files import Results
from pyrofit.results.kinetics import fixed_for_imp
from pyrofit.solver.arrays import FloatArray
from pyrofit.stages.imp_likelihood import imp_likelihood

AT_ONCE = 128
"""Sets of a piece of work."""


@dataclass(frozen=True, eq=False)
class Scorer:
    """All costs at once: a set is simulated once, and scored by each.

    Parameters
    ----------
    problem
        Its terms are those of all costs one after the other, then the likelihood's channels.
    measures
        The costs.
    likelihood
        The likelihood, where it is asked for.
    """

    problem: Problem
    measures: tuple[Measure, ...]
    likelihood: Likelihood | None

    def scores(self, sets: FloatArray) -> FloatArray:
        """Return the value of each cost, shape (sets, costs); not a number where a run fails."""
        outcomes = self.problem.simulate_all(sets)
        pairs = zip(sets, outcomes, strict=True)
        return np.array([self.of(values, outcome) for values, outcome in pairs])

    def of(self, values: FloatArray, outcome: Outcome) -> list[float]:
        """Return the value of each cost for one set, from how its simulation ended."""
        status, models = outcome
        if not status.finished:
            return [np.nan] * len(self.measures)
        parts = self.problem.cost.parts(models)
        found, first = [], 0
        for measure in self.measures:
            last = first + len(measure.terms)
            value = sum(parts[first:last]) if measure.terms else self._chi2(values, models)
            found.append(float(value))
            first = last
        return found

    def _chi2(self, values: FloatArray, models: list[FloatArray]) -> float:
        likelihood = self.likelihood
        assert likelihood is not None
        channels = len(likelihood.noise)
        measured = [term.target.value for _, term in self.problem.cost.terms[-channels:]]
        white = likelihood.whiten(np.concatenate(models[-channels:]) - np.concatenate(measured))
        known = likelihood.prior.residuals(values[None])[0]
        return linear.dot(white, white) + linear.dot(known, known)


def scorer_of(
    study: Study,
    results: Results,
    measurements: Measurements,
    measures: Sequence[Measure],
    searched: bool = True,
) -> tuple[Scorer, list[str]]:
    """Return the scorer of some costs, and which cannot be computed and why.

    The likelihood is that of `imp_likelihood`, after the searches or before.
    """
    fixed = fixed_for_imp(study, results)

    def posed(specs: Sequence[TermSpec]) -> Problem:
        return pose(study, of_imp(study, specs), measurements, fixed)

    specs = [term for measure in measures for term in measure.terms]
    if all(measure.terms for measure in measures):
        return Scorer(posed(specs), tuple(measures), None), []
    try:
        likelihood = imp_likelihood(study, results, of_imp(study), searched)
    except DataError as error:
        rest = tuple(measure for measure in measures if measure.terms)
        if not rest:
            raise
        return Scorer(posed(specs), rest, None), [f"{LIKELIHOOD}: {error}"]
    return Scorer(posed([*specs, *study.imp.channels]), tuple(measures), likelihood), []


def scored_sets(scorer: Scorer, sets: FloatArray, cores: int) -> FloatArray:
    """Return the scores of all sets; they do not depend on the number of processes."""
    size = max(AT_ONCE, -(-len(sets) // MOST_PIECES))
    starts = range(0, len(sets), size)
    pieces = parallel_map(
        lambda i: scorer.scores(sets[starts[i] : starts[i] + size]), len(starts), cores
    )
    return np.concatenate(pieces)
