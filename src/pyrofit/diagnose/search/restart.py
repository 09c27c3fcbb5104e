"""Fits from other starts: from models with more effects, and from other points of the limits."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import islice

import numpy as np

from pyrofit.diagnose.base.descent import Fit, descend_chi_square, refreshed
from pyrofit.diagnose.base.fitted import FittedModel, Key, followed, lower_of, misfits_badly
from pyrofit.diagnose.base.model import extended, model_of, strength_of
from pyrofit.diagnose.search.step import SearchContext, in_order
from pyrofit.numerics import linear
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray


def best_of_each(trials: Sequence[FittedModel]) -> list[FittedModel]:
    """Return the lowest fit of each model, the best penalised chi-square first."""
    best: dict[Key, FittedModel] = {}
    for trial in in_order(trials):
        best.setdefault(trial.key, trial)
    return list(best.values())


def restarted(
    tasks: Sequence[tuple[FittedModel, Sequence[FittedModel]]], context: SearchContext
) -> list[FittedModel]:
    """Return the models that steps started from, where followers lead to a lower minimum of them.

    A further effect may gain only because its fit starts anew. The leading models of each step are
    therefore fitted again without it, each from where it ended.
    """
    wanted = []
    for start, trials in tasks:
        larger = [trial for trial in trials if set(trial.effects) > set(start.effects)]
        wanted.append([(t, start.effects) for t in larger[: start.settings.most_restarts]])
    again = iter(_reduced([task for of_step in wanted for task in of_step], context.processes))
    found = []
    for (start, _), of_step in zip(tasks, wanted, strict=True):
        ends = list(islice(again, len(of_step)))
        best = min(ends, key=lambda trial: trial.penalised, default=start)
        lower = best.penalised < start.penalised - start.settings.same_valley
        found.append(best if lower else start)
    return found


def from_other_starts(trials: Sequence[FittedModel], context: SearchContext) -> list[FittedModel]:
    """Fit the leading models from other points, where even the best one misfits much.

    The base fit may lie far from the valley in which an effect explains the data.
    """
    if not trials or not context.other_starts or not misfits_badly(trials[0]):
        return []
    leading = trials[: trials[0].settings.most_refitted]
    begins = [(t, x) for t in leading for x in context.other_starts]

    def end(i: int) -> Fit:
        trial, x = begins[i]
        rough = descend_chi_square(
            trial.model, _start(trial, x), enough=trial.settings.rough_gain, known=trial.fit
        )
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
    chi2 = [linear.dot(r, r) for r in trial.model.residuals_all(np.array(points))]
    return points[int(np.argmin(chi2))]


def refitted_without(
    trial: FittedModel, effects: Sequence[str], processes: int = 1
) -> list[FittedModel]:
    """Fit the model without each of some effects, from where it stands."""
    kept = [[name for name in trial.effects if name != effect] for effect in effects]
    return _reduced([(trial, names) for names in kept], processes)


def _reduced(
    tasks: Sequence[tuple[FittedModel, Sequence[str]]], processes: int
) -> list[FittedModel]:
    """Fit models with only the named effects of theirs, each from where it stands."""
    models = [
        model_of(
            trial.model.base,
            {name: free for name, free in trial.model.effects.items() if name in names},
            trial.model.channels,
        )
        for trial, names in tasks
    ]

    def fit(k: int) -> Fit:
        whole = tasks[k][0]
        keep = [name in models[k].names for name in whole.model.names]
        return refreshed(
            models[k], descend_chi_square(models[k], whole.fit.x[keep], whole.fit.jacobian[:, keep])
        )

    return list(map(FittedModel, models, parallel_map(fit, len(models), processes)))
