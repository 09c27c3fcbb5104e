"""Fits from other starts: from models with more effects, and from other points of the limits."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend, refreshed
from pyrofit.diagnose.base.fitted import FittedModel, followed, lower_of
from pyrofit.diagnose.base.model import Base, Free, extended, model_of, strength_of
from pyrofit.diagnose.search.step import SearchContext, in_order
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray


def best_of_each(trials: Sequence[FittedModel]) -> list[FittedModel]:
    """Return the lowest fit of each model, the best penalised chi-square first."""
    best: dict[object, FittedModel] = {}
    for trial in in_order(trials):
        best.setdefault(frozenset(trial.model.effects.items()), trial)
    return list(best.values())


def restarted(
    start: FittedModel, trials: Sequence[FittedModel], context: SearchContext
) -> FittedModel:
    """Return the model that a step started from, where its followers lead to a lower minimum of it.

    A further effect may gain only because its fit starts anew. The leading models are therefore
    fitted again without it, each from where it ended.
    """
    leading = [t for t in trials if set(t.effects) > set(start.effects)][: SETTINGS.most_restarts]
    base, channels, of = start.model.base, start.model.channels, set(start.effects)

    def kept(trial: FittedModel) -> Free:
        return {name: free for name, free in trial.model.effects.items() if name in of}

    def without(k: int) -> FittedModel:
        trial = leading[k]
        model = model_of(base, kept(trial), channels)
        keep = [name in model.names for name in trial.model.names]
        return FittedModel(model, descend(model, trial.fit.x[keep]))

    best = start
    for k, fit in enumerate(
        parallel_map(lambda k: without(k).fit, len(leading), context.processes)
    ):
        trial = FittedModel(model_of(base, kept(leading[k]), channels), fit)
        if trial.penalised < best.penalised - SETTINGS.same_valley:
            best = trial
    return best if best is start else replace(best, fit=refreshed(best.model, best.fit))


def from_other_starts(trials: Sequence[FittedModel], context: SearchContext) -> list[FittedModel]:
    """Fit the leading models from other points, where even the best one misfits much.

    The base fit may lie far from the valley in which an effect explains the data.
    """
    if not trials or not context.other_starts:
        return []
    if trials[0].fit.chi2 <= SETTINGS.misfit_chi2_per_point * trials[0].model.points:
        return []
    leading = trials[: SETTINGS.most_refitted]
    begins = [(t, x) for t in leading for x in context.other_starts]

    def end(i: int) -> Fit:
        trial, x = begins[i]
        rough = descend(trial.model, _start(trial, x), enough=SETTINGS.rough_gain)
        return followed(replace(trial, fit=rough)).fit if rough.chi2 < trial.fit.chi2 else rough

    found = list(leading)
    ends = parallel_map(end, len(begins), context.processes)
    for i, fit in enumerate(ends):
        k = i // len(context.other_starts)
        found[k] = lower_of(found[k], fit)
    return [trial for trial, before in zip(found, leading, strict=True) if trial is not before]


def _start(trial: FittedModel, x: FloatArray) -> FloatArray:
    """Return a point of the base with the effects at the typical strength that fits best."""
    points = []
    for size in (0.3, 1.0, 3.0):
        at = x
        for effect, (_, *form) in trial.model.effects.items():
            _, quantity = strength_of(effect)
            strength = quantity.value + size * (quantity.typical - quantity.value)
            at = extended(at, effect, strength, form)
        points.append(at)
    chi2 = [float(r @ r) for r in trial.model.residuals_all(np.array(points))]
    return points[int(np.argmin(chi2))]


def dropped(trial: FittedModel, effects: Sequence[str], processes: int = 1) -> list[FittedModel]:
    """Fit the model without each of some effects, from where it stands."""
    base: Base = trial.model.base
    of = trial.model.effects
    free = [{name: of[name] for name in of if name != effect} for effect in effects]
    models = [model_of(base, kept, trial.model.channels) for kept in free]

    def fit(k: int) -> Fit:
        keep = [name in models[k].names for name in trial.model.names]
        return refreshed(models[k], descend(models[k], trial.fit.x[keep]))

    return list(map(FittedModel, models, parallel_map(fit, len(models), processes)))
