"""The set to predict with."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.analysis.distances import Distance
from pyrofit.analysis.scores import Score
from pyrofit.analysis.uses import HELD_OUT, PUBLISHED
from pyrofit.numerics import functions

_BEST = " best"
_LEAST = 1e-300


@dataclass(frozen=True)
class Recommended:
    """A set, and by which data it was selected.

    Parameters
    ----------
    cost_function, found_by
        The set: cost function and optimiser.
    sets
        Number of sets it was selected from.
    held_out
        Scores of all these sets at the held-out signals; none where it was selected by its fit.
    """

    cost_function: str
    found_by: str
    sets: int
    held_out: tuple[Score, ...] = ()

    def of(self, scores: Iterable[Score]) -> list[Score]:
        """Return the scores of this set among some."""
        mine = (self.cost_function, self.found_by)
        return [s for s in scores if (s.cost_function, s.found_by) == mine]


def recommended(scores: Sequence[Score], distances: Sequence[Distance]) -> Recommended:
    """Select the set that predicts held-out experiments best; without such, the one that fits best.

    Predictions are compared by the mean over held-out signals of ln(error), which weighs a factor
    of two alike in all units. An experiment is held out if no cost function was fitted to it. The
    fit is compared by chi-square, which weighs each point by its noise.
    """
    ours = [score for score in scores if score.found_by != PUBLISHED]
    fitted = {score.experiment for score in ours if score.use != HELD_OUT}
    held_out = tuple(score for score in ours if score.experiment not in fitted)
    if held_out:
        errors: dict[tuple[str, str], list[float]] = {}
        for score in held_out:
            logarithm = float(functions.log(max(score.value, _LEAST)))
            errors.setdefault((score.cost_function, score.found_by), []).append(logarithm)
        cost, by = min(errors, key=lambda one: float(np.mean(errors[one])))
        return Recommended(cost, by, len(errors), held_out)
    best = [distance for distance in distances if distance.set.endswith(_BEST)]
    least = min(best, key=lambda distance: distance.chi2_per_freedom)
    return Recommended(least.cost_function, least.set.removesuffix(_BEST), len(best))
