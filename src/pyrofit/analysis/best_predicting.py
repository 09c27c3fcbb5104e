"""The set of a search that predicts held-out tests best: a finding on methods."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.analysis.scores import Score
from pyrofit.analysis.uses import ESTIMATES, HELD_OUT, PUBLISHED
from pyrofit.numerics import functions

_LEAST = 1e-300


@dataclass(frozen=True)
class BestPredicting:
    """A set, and the scores it was selected by.

    Parameters
    ----------
    cost_function, found_by
        The set: cost function and optimiser.
    sets
        Number of sets it was selected from.
    scores
        Its scores at the held-out signals.
    """

    cost_function: str
    found_by: str
    sets: int
    scores: tuple[Score, ...]


def of_answer(scores: Iterable[Score]) -> list[Score]:
    """Return the scores of the estimates among some."""
    return [score for score in scores if score.found_by == ESTIMATES]


def never_fitted(scores: Iterable[Score]) -> list[Score]:
    """Return the scores at tests that neither a cost function nor the estimates were fitted to."""
    ours = [score for score in scores if score.found_by != PUBLISHED]
    fitted = {score.experiment for score in ours if score.use != HELD_OUT}
    return [score for score in ours if score.experiment not in fitted]


def best_predicting(scores: Sequence[Score]) -> BestPredicting | None:
    """Select the set of a search that predicts held-out tests best; none without such tests.

    Predictions are compared by the mean over held-out signals of ln(error), which weighs a factor
    of two alike in all units. A test is held out if nothing was fitted to it.
    """
    groups: dict[tuple[str, str], list[Score]] = {}
    for score in never_fitted(scores):
        if score.found_by != ESTIMATES:
            groups.setdefault((score.cost_function, score.found_by), []).append(score)
    if not groups:
        return None
    cost, by = min(groups, key=lambda one: _error(groups[one]))
    return BestPredicting(cost, by, len(groups), tuple(groups[cost, by]))


def _error(scores: Sequence[Score]) -> float:
    return float(np.mean([float(functions.log(max(s.value, _LEAST))) for s in scores]))
