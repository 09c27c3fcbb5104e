"""The search: every effect alone, the leading ones in other forms, then pairs, then three."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.diagnose.descent import Fit, descend, refreshed
from pyrofit.diagnose.gates import at_limit
from pyrofit.diagnose.locate import Alarm, alarm
from pyrofit.diagnose.model import Base, model_of
from pyrofit.diagnose.refit import (
    Trial,
    from_best_start,
    from_elsewhere,
    look_at,
    model_with,
    model_with_form,
    polished,
    up_to_date,
    with_effect,
    with_form,
)
from pyrofit.diagnose.screen import Look
from pyrofit.diagnose.setup import blurred, clearer, refitted, with_noise_about
from pyrofit.diagnose.share import shared
from pyrofit.effects import known_effects

LEADING = 3
"""Effects about which the noise is estimated again."""
FORMED = 5
"""Effects that are tried in other forms."""
AMBIGUOUS = 9.0
"""Models whose penalised chi-square is above the best one's by less are not told apart."""
HOPELESS = 50.0
"""How far above the best chi-square a fit ends that is not searched on from other starts."""
LITTLE = 0.01
"""An effect that lowers chi-square by less than this part may have started in the wrong place."""
POLISHED = 5
"""Models that are searched on from elsewhere in what the data hardly determine."""
BEAM = 2
"""Models that are carried on from one effect to the next."""
BRANCHES = 8
"""Effects that are tried as the second or third one in addition to the second best model."""

CLEARER = 6.0
"""What the noise must explain more, in BIC, to be worth new fits."""

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


@dataclass(frozen=True, eq=False)
class Search:
    """All rounds in order, and the model they end with: the base itself, or one with effects."""

    rounds: tuple[Round, ...]
    end: Trial
    end_alarm: Alarm
    spare: float
    """2 log(M): what the penalised chi-square must fall by to claim one of M effects, so that
    chi-square falls by log(n) + 2 log(M) (Chen and Chen 2008, doi 10.1093/biomet/asn034)."""

    @property
    def base(self) -> Trial:
        """The base model's fit."""
        return self.rounds[0].start

    @property
    def trials(self) -> list[Trial]:
        """All fits with effects."""
        return [trial for step in self.rounds for trial in step.trials]


def search(base: Trial, effects: Sequence[str], most: int, means: Means) -> Search:
    """Add effects to the base until what is left is noise, none gains enough, or there are most.

    Where more than noise is left, the noise is estimated about the end, and if that explains more
    the search is made once more: what the base cannot follow may have been taken for noise.

    Parameters
    ----------
    base
        The fitted base model.
    effects
        Names of the candidates.
    most
        Most effects of a model.
    means
        Noise, listener, processes.
    """
    found = _search(base, effects, most, means)
    if found.end_alarm.adequate or not found.end.effects:
        return found
    sharper = with_noise_about(found.end, processes=means.processes)
    if clearer(found.end.model.base, sharper) < CLEARER:
        return found
    means.tell("once more, with the noise about the best model")
    return _search(refitted(found.base, sharper), effects, most, means)


def _search(base: Trial, effects: Sequence[str], most: int, means: Means) -> Search:
    spare = 2.0 * float(np.log(max(len(effects), 1)))
    first = _sharp(_look(base, effects, means), means)
    best, best_alarm, rounds = first.start, first.alarm, [first]
    if first.alarm.silent:
        return Search((first,), best, best_alarm, spare)
    rounds = [replace(first, trials=_singles(first, means))]
    beam = _claims(rounds, spare)
    while beam:
        steps = [_onwards(beam[0], effects, means)]
        more = len(beam[0].effects) - len(best.effects)
        if best.penalised - beam[0].penalised >= more * spare:
            best, best_alarm = steps[0].start, steps[0].alarm
        if best_alarm.silent or len(beam[0].effects) >= most:
            break
        steps += [_onwards(trial, effects, means) for trial in beam[1:]]
        # The best may get any effect more; the other those that promise most.
        steps = [
            replace(step, trials=_more(step, BRANCHES if i else len(effects), means))
            for i, step in enumerate(steps)
        ]
        rounds += steps
        beam = _claims(steps, spare)
    return Search(tuple(rounds), best, best_alarm, spare)


def _onwards(trial: Trial, effects: Sequence[str], means: Means) -> Round:
    return _look(
        up_to_date(trial), [effect for effect in effects if effect not in trial.effects], means
    )


def _sharp(step: Round, means: Means) -> Round:
    """Return the first look with a noise that does not count the misfit of the base as noise.

    The noise is estimated again about the most promising models with one effect.
    """
    if step.alarm.silent and not blurred(step.start.model.base):
        return step
    order = sorted(step.looks, key=lambda look: float(look.ahead.min()))[:LEADING]
    if not order:
        return step
    fits = shared(lambda i: with_effect(step.start, order[i]).fit, len(order), means.processes)
    at = int(np.argmin([fit.chi2 for fit in fits]))
    best = Trial(model_with(step.start, order[at].effect), fits[at])
    base = with_noise_about(best, processes=means.processes)
    if clearer(best.model.base, base) < CLEARER:
        return step
    start = refitted(step.start, base)
    return _look(start, [look.effect for look in step.looks], means)


def _look(trial: Trial, effects: Sequence[str], means: Means) -> Round:
    looks = look_at(trial, effects, means.processes)
    return Round(
        trial, alarm(trial.model, trial.fit, looks, means.rng, means.processes), tuple(looks)
    )


def _singles(step: Round, means: Means) -> tuple[Trial, ...]:
    """Fit every effect alone, then the leading ones that have several forms in these."""
    trials = _polished(_fitted(step, len(step.looks), means), means)
    catalogue = known_effects()
    leading = [trial for trial in trials if catalogue[trial.effects[-1]].form][:FORMED]
    return _sorted([*trials, *_forms(leading, means)])


def _more(step: Round, most_tried: int, means: Means) -> tuple[Trial, ...]:
    """Fit one effect more, those that promise most."""
    trials = _polished(_fitted(step, most_tried, means), means)
    return _sorted([*trials, *_forms(trials[:1], means)])


def _fitted(step: Round, most: int, means: Means) -> list[Trial]:
    """Fit one effect more, those that promise most, and the best of these from several starts."""
    start, processes = step.start, means.processes
    looks = sorted(step.looks, key=lambda look: float(look.ahead.min()))[:most]
    fits = shared(lambda i: from_best_start(start, looks[i]).fit, len(looks), processes)
    trials = [
        Trial(model_with(start, look.effect), fit) for look, fit in zip(looks, fits, strict=True)
    ]
    best = min((fit.chi2 for fit in fits), default=0.0)
    little = (1.0 - LITTLE) * start.fit.chi2
    near = [i for i, f in enumerate(fits) if f.chi2 <= best + HOPELESS or f.chi2 > little]
    ends = shared(
        lambda k: from_elsewhere(start, looks[near[k]], trials[near[k]]).fit, len(near), processes
    )
    for i, end in zip(near, ends, strict=True):
        trials[i] = replace(trials[i], fit=end)
    return _told(trials, means)


def _forms(leading: Sequence[Trial], means: Means) -> list[Trial]:
    """Fit the last effect of each model with each of its form parameters free."""
    catalogue = known_effects()
    forms = [(t, form) for t in leading for form in catalogue[t.effects[-1]].form]
    fits = shared(lambda i: with_form(*forms[i]).fit, len(forms), means.processes)
    models = [model_with_form(trial, form) for trial, form in forms]
    return _told(list(map(Trial, models, fits)), means)


def _polished(trials: Sequence[Trial], means: Means) -> list[Trial]:
    """Return the trials in order, the leading ones searched on from elsewhere."""
    order = _sorted(trials)
    leading = [t for t in order[:POLISHED] if t.penalised <= order[0].penalised + HOPELESS]
    better = polished(leading, means.processes)
    return list(_sorted([*better, *order[len(leading) :]]))


def _told(trials: list[Trial], means: Means) -> list[Trial]:
    for trial in trials:
        free = [f"{e} ({', '.join(f)})" for e, f in trial.model.effects.items()]
        means.tell(f"{' + '.join(free)}: chi-square {trial.fit.chi2:.1f}")
    return trials


def _sorted(trials: Sequence[Trial]) -> tuple[Trial, ...]:
    return tuple(sorted(trials, key=lambda trial: trial.penalised))


def _claims(steps: Sequence[Round], spare: float) -> list[Trial]:
    """Return the best trials that gain enough over the model they started from, each effect once.

    Those with a strength at a limit, which may not be claimed, only where there are no others.
    """
    found = [
        trial
        for step in steps
        for trial in step.trials
        if step.start.penalised - trial.penalised >= spare
    ]
    inside = [trial for trial in found if not any(at_limit(trial, e) for e in trial.effects)]
    best: dict[frozenset[str], Trial] = {}
    for trial in _sorted(inside or found):
        best.setdefault(frozenset(trial.effects), trial)
    return list(best.values())[:BEAM]


def dropped(trial: Trial, effects: Sequence[str], processes: int = 1) -> list[Trial]:
    """Fit the model without each of some effects, from where it stands."""
    base: Base = trial.model.base
    of = trial.model.effects
    free = [{name: of[name] for name in of if name != effect} for effect in effects]
    models = [model_of(base, kept, trial.model.channels) for kept in free]

    def fit(k: int) -> Fit:
        keep = [name in models[k].names for name in trial.model.names]
        return refreshed(models[k], descend(models[k], trial.fit.x[keep]))

    return list(map(Trial, models, shared(fit, len(models), processes)))
