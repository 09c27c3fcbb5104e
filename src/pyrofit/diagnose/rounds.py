"""One round of the search: every effect more in addition to a model, and in other forms."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from pyrofit.diagnose.locate import Alarm
from pyrofit.diagnose.refit import (
    ROUGH,
    Trial,
    followed,
    from_best_start,
    from_elsewhere,
    model_with,
    model_with_form,
    polished,
    starts,
    with_form,
)
from pyrofit.diagnose.screen import Look
from pyrofit.effects import known_effects
from pyrofit.parallel import parallel_map

FORMED = 5
"""Effects that are tried in other forms."""
HOPELESS = 50.0
"""How far above the best chi-square a fit ends that is not followed to its end."""
LITTLE = 0.005
"""An effect that lowers chi-square by less than this share may have started in the wrong place."""
POLISHED = 5
"""Models that are searched on from elsewhere in what the data hardly determine."""

Tell = Callable[[str], None]


@dataclass(frozen=True, eq=False)
class Means:
    """What a search works with: draws of noise, someone who is told what goes on, processes."""

    rng: np.random.Generator
    tell: Tell = lambda text: None
    processes: int = 1


@dataclass(frozen=True, eq=False)
class Round:
    """One step of the search.

    Parameters
    ----------
    start
        The model that gets one effect more.
    alarm
        What its fit leaves.
    looks
        What each effect would change of it.
    trials
        The fits with one effect more, the best penalised chi-square first.
    """

    start: Trial
    alarm: Alarm
    looks: tuple[Look, ...]
    trials: tuple[Trial, ...] = ()


def singles(step: Round, means: Means) -> tuple[Trial, ...]:
    """Fit every effect alone, then the leading ones that have several forms in these."""
    trials = _polished(_fitted(step, len(step.looks), means), means)
    catalogue = known_effects()
    leading = [trial for trial in trials if catalogue[trial.effects[-1]].form][:FORMED]
    return in_order([*trials, *_forms(leading, means)])


def more(step: Round, most_tried: int, means: Means) -> tuple[Trial, ...]:
    """Fit one effect more, those that promise most."""
    trials = _polished(_fitted(step, most_tried, means), means)
    return in_order([*trials, *_forms(trials[:1], means)])


def _fitted(step: Round, most: int, means: Means) -> list[Trial]:
    """Fit one effect more, those that promise most.

    Roughly first, those that gain next to nothing from a second start as well. Those that come near
    the best one are then fitted to the end, from the other starts, too.
    """
    start, processes = step.start, means.processes
    looks = sorted(step.looks, key=lambda look: float(look.ahead.min()))[:most]
    others = [starts(look)[1:] for look in looks]
    fits = parallel_map(
        lambda i: from_best_start(start, looks[i], ROUGH).fit, len(looks), processes
    )
    models = [model_with(start, look.effect) for look in looks]
    found = list(map(Trial, models, fits))

    def again(which: list[int], fit: Callable[[int], Trial]) -> None:
        ends = parallel_map(lambda k: fit(which[k]).fit, len(which), processes)
        for i, end in zip(which, ends, strict=True):
            found[i] = Trial(models[i], end)

    def once_more(i: int) -> Trial:
        return from_elsewhere(start, looks[i], found[i], others[i][:1], ROUGH)

    def to_the_end(i: int) -> Trial:
        return from_elsewhere(start, looks[i], followed(found[i]), others[i])

    little = (1.0 - LITTLE) * start.fit.chi2
    again([i for i, trial in enumerate(found) if trial.fit.chi2 > little], once_more)
    hopeful = min((trial.fit.chi2 for trial in found), default=0.0) + HOPELESS
    again([i for i, trial in enumerate(found) if trial.fit.chi2 <= hopeful], to_the_end)
    return _told(found, means)


def _forms(leading: Sequence[Trial], means: Means) -> list[Trial]:
    """Fit the last effect of each model with each of its form parameters free."""
    catalogue = known_effects()
    forms = [(t, form) for t in leading for form in catalogue[t.effects[-1]].form]
    fits = parallel_map(lambda i: with_form(*forms[i]).fit, len(forms), means.processes)
    models = [model_with_form(trial, form) for trial, form in forms]
    return _told(list(map(Trial, models, fits)), means)


def _polished(trials: Sequence[Trial], means: Means) -> list[Trial]:
    """Return the trials in order, the leading ones searched on from elsewhere."""
    order = in_order(trials)
    leading = [t for t in order[:POLISHED] if t.penalised <= order[0].penalised + HOPELESS]
    better = polished(leading, means.processes)
    return list(in_order([*better, *order[len(leading) :]]))


def _told(trials: list[Trial], means: Means) -> list[Trial]:
    for trial in trials:
        free = [f"{e} ({', '.join(f)})" for e, f in trial.model.effects.items()]
        means.tell(f"{' + '.join(free)}: chi-square {trial.fit.chi2:.1f}")
    return trials


def in_order(trials: Sequence[Trial]) -> tuple[Trial, ...]:
    """Return trials, the best penalised chi-square first."""
    return tuple(sorted(trials, key=lambda trial: trial.penalised))
