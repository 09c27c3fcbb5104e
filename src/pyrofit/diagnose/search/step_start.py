"""The start of a step of the search: a fitted model, and its change by each effect."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from pyrofit.diagnose.base.adequacy import LackOfFit, lack_of_fit
from pyrofit.diagnose.base.fit import blurred, is_clearer, refitted, sharpened
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.search.refit import look_at, model_with, with_effect
from pyrofit.diagnose.search.step import SearchContext, SearchStep, most_promising
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.parallel import parallel_map


def step_from(trial: FittedModel, effects: Sequence[str], context: SearchContext) -> SearchStep:
    """Return a step from a fitted model: its change by each effect, and its lack of fit."""
    looks = look_at(trial, effects, context.processes)
    (rng,) = context.rng.spawn(1)

    @cache
    def lack() -> LackOfFit:
        directions = [look.directions for look in looks]
        return lack_of_fit(trial.model, trial.fit, directions, rng, context.processes)

    return SearchStep(trial, lack, tuple(looks))


def with_sharp_noise(step: SearchStep, context: SearchContext) -> SearchStep:
    """Return the first step with a noise that does not count the misfit of the base as noise.

    The noise is estimated again about the most promising models with one effect.
    """
    if step.lack().passes and not blurred(step.start.model.base):
        return step
    order = most_promising(step, SETTINGS.noise_leaders)
    if not order:
        return step
    fits = parallel_map(
        lambda i: with_effect(step.start, order[i]).fit, len(order), context.processes
    )
    at = int(np.argmin([fit.chi2 for fit in fits]))
    best = FittedModel(model_with(step.start, order[at].effect), fits[at])
    base = sharpened(best, context.processes)
    if not is_clearer(base, best.model.base):
        return step
    start = refitted(step.start, base)
    return step_from(start, [look.effect for look in step.looks], context)
