"""One round of the search: every effect more in addition to a model, and in other forms."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.base.adequacy import LackOfFit
from pyrofit.diagnose.base.fitted import FittedModel, followed, polished
from pyrofit.diagnose.search.refit import (
    fixed_forms,
    from_best_start,
    from_elsewhere,
    model_with,
    model_with_form,
    starts,
    with_form,
)
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.parallel import parallel_map
from pyrofit.solver.arrays import FloatArray

Tell = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class SearchContext:
    """Inputs of a search: generator of noise draws, listener to its progress, processes."""

    rng: np.random.Generator
    tell: Tell = lambda text: None
    processes: int = 1
    other_starts: tuple[FloatArray, ...] = ()
    """Points of the base model's limits from which leading models are fitted as well."""


@dataclass(frozen=True, eq=False)
class SearchStep:
    """One step of the search.

    Parameters
    ----------
    start
        The model that gets one effect more.
    lack
        Lack of fit of that model.
    looks
        Change of that model by each effect.
    trials
        The fits with one effect more, the best penalised chi-square first.
    """

    start: FittedModel
    lack: LackOfFit
    looks: tuple[Screening, ...]
    trials: tuple[FittedModel, ...] = ()


def singles(step: SearchStep, context: SearchContext) -> tuple[FittedModel, ...]:
    """Fit every effect alone, then the leading ones that have several forms in these."""
    trials = _polished(_fitted(step, len(step.looks), context), context)
    leading = [trial for trial in trials if fixed_forms(trial)][: SETTINGS.most_formed]
    return in_order([*trials, *_forms(leading, context)])


def more(step: SearchStep, most_tried: int, context: SearchContext) -> tuple[FittedModel, ...]:
    """Fit one effect more, those that promise most, then the best model in other forms."""
    trials = _polished(_fitted(step, most_tried, context), context)
    return in_order([*trials, *_forms(trials[:1], context)])


def _fitted(step: SearchStep, most: int, context: SearchContext) -> list[FittedModel]:
    """Fit one effect more, those that promise most.

    Roughly first, those that gain next to nothing from a second start as well. Those that come near
    the best one are then fitted to the end, from the other starts, too.
    """
    start, processes = step.start, context.processes
    looks = sorted(step.looks, key=lambda look: float(look.ahead.min()))[:most]
    others = [starts(look)[1:] for look in looks]
    fits = parallel_map(
        lambda i: from_best_start(start, looks[i], SETTINGS.rough_gain).fit, len(looks), processes
    )
    models = [model_with(start, look.effect) for look in looks]
    found = list(map(FittedModel, models, fits))

    def again(which: list[int], fit: Callable[[int], FittedModel]) -> None:
        ends = parallel_map(lambda k: fit(which[k]).fit, len(which), processes)
        for i, end in zip(which, ends, strict=True):
            found[i] = FittedModel(models[i], end)

    def once_more(i: int) -> FittedModel:
        return from_elsewhere(start, looks[i], found[i], others[i][:1], SETTINGS.rough_gain)

    def to_the_end(i: int) -> FittedModel:
        return from_elsewhere(start, looks[i], followed(found[i]), others[i])

    little = (1.0 - SETTINGS.little_gain_share) * start.fit.chi2
    again([i for i, trial in enumerate(found) if trial.fit.chi2 > little], once_more)
    hopeful = min((trial.fit.chi2 for trial in found), default=0.0) + SETTINGS.hopeless_chi2
    again([i for i, trial in enumerate(found) if trial.fit.chi2 <= hopeful], to_the_end)
    return _told(found, context)


def _forms(leading: Sequence[FittedModel], context: SearchContext) -> list[FittedModel]:
    """Fit each model with one form parameter more, then the best one with a second, if that pays.

    Models whose form parameter lowers the penalised chi-square are searched on from elsewhere:
    otherwise a further effect may gain only because its fit starts anew.
    """
    found: list[FittedModel] = []
    for _ in range(SETTINGS.most_form_parameters):
        tasks = [(trial, *form) for trial in leading for form in fixed_forms(trial)]
        if not tasks:
            break
        formed = _told(_with_forms(tasks, context.processes), context)
        paying = [
            trial
            for trial, (start, *_) in zip(formed, tasks, strict=True)
            if trial.penalised < start.penalised
        ]
        paying = polished(in_order(paying)[: SETTINGS.most_polished_forms], context.processes)
        found += [*formed, *paying]
        leading = in_order(paying)[:1]
    return found


def _with_forms(tasks: Sequence[tuple[FittedModel, str, str]], processes: int) -> list[FittedModel]:
    """Fit a model with a form parameter of an effect more, for each such task."""
    fits = parallel_map(lambda i: with_form(*tasks[i]).fit, len(tasks), processes)
    return list(map(FittedModel, (model_with_form(*task) for task in tasks), fits))


def _polished(trials: Sequence[FittedModel], context: SearchContext) -> list[FittedModel]:
    """Return the trials in order, the leading ones searched on from elsewhere."""
    order = in_order(trials)
    leading = [
        t
        for t in order[: SETTINGS.most_polished]
        if t.penalised <= order[0].penalised + SETTINGS.hopeless_chi2
    ]
    better = polished(leading, context.processes)
    return list(in_order([*better, *order[len(leading) :]]))


def _told(trials: list[FittedModel], context: SearchContext) -> list[FittedModel]:
    for trial in trials:
        free = [f"{e} ({', '.join(f)})" for e, f in trial.model.effects.items()]
        context.tell(f"{' + '.join(free)}: chi-square {trial.fit.chi2:.1f}")
    return trials


def in_order(trials: Sequence[FittedModel]) -> tuple[FittedModel, ...]:
    """Return trials, the best penalised chi-square first."""
    return tuple(sorted(trials, key=lambda trial: trial.penalised))
