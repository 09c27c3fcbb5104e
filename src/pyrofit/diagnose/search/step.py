"""One round of the search: every effect more in addition to a model, and in other forms."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.base.adequacy import LackOfFit
from pyrofit.diagnose.base.fitted import FittedModel, followed, polished
from pyrofit.diagnose.search.refit import (
    from_best_start,
    from_elsewhere,
    model_with,
    model_with_form,
    starts,
    with_form,
)
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.effects import known_effects
from pyrofit.parallel import parallel_map

Tell = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class SearchContext:
    """What a search works with: draws of noise, someone who is told what goes on, processes."""

    rng: np.random.Generator
    tell: Tell = lambda text: None
    processes: int = 1


@dataclass(frozen=True, eq=False)
class SearchStep:
    """One step of the search.

    Parameters
    ----------
    start
        The model that gets one effect more.
    lack
        What its fit leaves.
    looks
        What each effect would change of it.
    trials
        The fits with one effect more, the best penalised chi-square first.
    """

    start: FittedModel
    lack: LackOfFit
    looks: tuple[Screening, ...]
    trials: tuple[FittedModel, ...] = ()


def singles(step: SearchStep, means: SearchContext) -> tuple[FittedModel, ...]:
    """Fit every effect alone, then the leading ones that have several forms in these."""
    trials = _polished(_fitted(step, len(step.looks), means), means)
    catalogue = known_effects()
    leading = [trial for trial in trials if catalogue[trial.effects[-1]].form][
        : SETTINGS.most_formed
    ]
    return in_order([*trials, *_forms(leading, means)])


def more(step: SearchStep, most_tried: int, means: SearchContext) -> tuple[FittedModel, ...]:
    """Fit one effect more, those that promise most."""
    trials = _polished(_fitted(step, most_tried, means), means)
    return in_order([*trials, *_forms(trials[:1], means)])


def _fitted(step: SearchStep, most: int, means: SearchContext) -> list[FittedModel]:
    """Fit one effect more, those that promise most.

    Roughly first, those that gain next to nothing from a second start as well. Those that come near
    the best one are then fitted to the end, from the other starts, too.
    """
    start, processes = step.start, means.processes
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
    return _told(found, means)


def _forms(leading: Sequence[FittedModel], means: SearchContext) -> list[FittedModel]:
    """Fit the last effect of each model with each of its form parameters free."""
    catalogue = known_effects()
    forms = [(t, form) for t in leading for form in catalogue[t.effects[-1]].form]
    fits = parallel_map(lambda i: with_form(*forms[i]).fit, len(forms), means.processes)
    models = [model_with_form(trial, form) for trial, form in forms]
    return _told(list(map(FittedModel, models, fits)), means)


def _polished(trials: Sequence[FittedModel], means: SearchContext) -> list[FittedModel]:
    """Return the trials in order, the leading ones searched on from elsewhere."""
    order = in_order(trials)
    leading = [
        t
        for t in order[: SETTINGS.most_polished]
        if t.penalised <= order[0].penalised + SETTINGS.hopeless_chi2
    ]
    better = polished(leading, means.processes)
    return list(in_order([*better, *order[len(leading) :]]))


def _told(trials: list[FittedModel], means: SearchContext) -> list[FittedModel]:
    for trial in trials:
        free = [f"{e} ({', '.join(f)})" for e, f in trial.model.effects.items()]
        means.tell(f"{' + '.join(free)}: chi-square {trial.fit.chi2:.1f}")
    return trials


def in_order(trials: Sequence[FittedModel]) -> tuple[FittedModel, ...]:
    """Return trials, the best penalised chi-square first."""
    return tuple(sorted(trials, key=lambda trial: trial.penalised))
