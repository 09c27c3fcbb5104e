"""The search: every effect alone, the leading ones in other forms, then pairs, then three."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.diagnose.descent import Fit, descend, refreshed
from pyrofit.diagnose.gates import at_limit
from pyrofit.diagnose.locate import Alarm, alarm
from pyrofit.diagnose.model import Base, model_of
from pyrofit.diagnose.refit import Trial, look_at, model_with, up_to_date, with_effect
from pyrofit.diagnose.rounds import Means, Round, in_order, more, singles
from pyrofit.diagnose.setup import blurred, clearer, refitted, with_noise_about
from pyrofit.parallel import parallel_map

LEADING = 3
"""Effects about which the noise is estimated again."""
AMBIGUOUS = 9.0
"""Models whose penalised chi-square is above the best one's by less are not told apart."""
BEAM = 2
"""Models that are carried on from one effect to the next."""
FAR = 10.0
"""One whose chi-square is that of the best one times more than this is not carried on."""
BRANCHES = 8
"""Effects that are tried as the second or third one in addition to the second best model."""
CLEARER = 6.0
"""What the noise must explain more, in BIC, to be worth new fits."""
MISFIT = 2.0
"""Where more than this of chi-square per point is left, misfit was not taken for noise."""


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
    off = found.end.fit.chi2 > MISFIT * found.end.model.points
    if found.end_alarm.adequate or not found.end.effects or off:
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
    rounds = [replace(first, trials=singles(first, means))]
    beam = _claims(rounds, spare)
    while beam:
        steps = [_onwards(beam[0], effects, means)]
        added = len(beam[0].effects) - len(best.effects)
        if best.penalised - beam[0].penalised >= added * spare:
            best, best_alarm = steps[0].start, steps[0].alarm
        if best_alarm.silent or len(beam[0].effects) >= most:
            break
        steps += [_onwards(trial, effects, means) for trial in beam[1:]]
        # The best may get any effect more; the other those that promise most.
        steps = [
            replace(step, trials=more(step, BRANCHES if i else len(effects), means))
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
    fits = parallel_map(
        lambda i: with_effect(step.start, order[i]).fit, len(order), means.processes
    )
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
    for trial in in_order(inside or found):
        best.setdefault(frozenset(trial.effects), trial)
    leading = list(best.values())[:BEAM]
    return [trial for trial in leading if trial.fit.chi2 <= FAR * leading[0].fit.chi2]


def dropped(trial: Trial, effects: Sequence[str], processes: int = 1) -> list[Trial]:
    """Fit the model without each of some effects, from where it stands."""
    base: Base = trial.model.base
    of = trial.model.effects
    free = [{name: of[name] for name in of if name != effect} for effect in effects]
    models = [model_of(base, kept, trial.model.channels) for kept in free]

    def fit(k: int) -> Fit:
        keep = [name in models[k].names for name in trial.model.names]
        return refreshed(models[k], descend(models[k], trial.fit.x[keep]))

    return list(map(Trial, models, parallel_map(fit, len(models), processes)))
