"""The start of a step of the search: a fitted model, and its change by each effect."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.base.adequacy import LackOfFit, lack_of_fit
from pyrofit.diagnose.base.fit import blurred, has_better_noise, refitted, sharpened
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.search.refit import look_at, model_with, with_effect
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.diagnose.search.step import SearchContext, SearchStep, most_promising
from pyrofit.parallel import parallel_map


def step_from(trial: FittedModel, effects: Sequence[str], context: SearchContext) -> SearchStep:
    """Return a step from a fitted model: its change by each effect, and its lack of fit."""
    looks = tuple(look_at(trial, effects, context.processes))
    (rng,) = context.rng.spawn(1)
    return SearchStep(trial, Lack(trial, looks, rng, context.processes), looks)


@dataclass(eq=False)
class Lack:
    """Draws the lack of fit of a model when it is first asked for."""

    trial: FittedModel
    looks: Sequence[Screening]
    rng: np.random.Generator
    processes: int
    found: LackOfFit | None = None

    def __call__(self) -> LackOfFit:
        """Return the lack of fit."""
        if self.found is None:
            directions = [look.directions for look in self.looks]
            model, fit = self.trial.model, self.trial.fit
            self.found = lack_of_fit(model, fit, directions, self.rng, self.processes)
        return self.found


def with_sharp_noise(step: SearchStep, context: SearchContext) -> SearchStep:
    """Return the first step with a noise that does not count the misfit of the base as noise.

    The noise is estimated again about the most promising models with one effect.
    """
    if step.lack().passes and not blurred(step.start.model.base):
        return step
    order = most_promising(step, step.start.settings.noise_leaders)
    if not order:
        return step
    fits = parallel_map(
        lambda i: with_effect(step.start, order[i]).fit, len(order), context.processes
    )
    at = int(np.argmin([fit.chi2 for fit in fits]))
    best = FittedModel(model_with(step.start, order[at].effect), fits[at])
    base = sharpened(best, context.processes)
    if not has_better_noise(base, best.model.base):
        return step
    start = refitted(step.start, base)
    return step_from(start, [look.effect for look in step.looks], context)
