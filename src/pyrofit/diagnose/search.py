"""The search: every effect alone, the leading ones in other forms, then pairs, then three."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.diagnose.descent import descend, refreshed
from pyrofit.diagnose.locate import Alarm, alarm
from pyrofit.diagnose.model import Base, model_of
from pyrofit.diagnose.refit import Trial, look_at, polished, with_effect, with_form
from pyrofit.diagnose.screen import Look
from pyrofit.diagnose.setup import blurred, clearer, refitted, with_noise_about
from pyrofit.effects import known_effects

LEADING = 3
"""Effects about which the noise is estimated again."""
FORMED = 5
"""Effects that are tried in other forms."""
AMBIGUOUS = 9.0
"""Models whose penalised chi-square is above the best one's by less are not told apart."""
POLISHED = 5
"""Models that are searched on from elsewhere in what the data hardly determine."""
BEAM = 2
"""Models that are carried on from one effect to the next."""
BRANCHES = 8
"""Effects that are tried as the second or third one, those that promise most."""

CLEARER = 6.0
"""What the noise must explain more, in BIC, to be worth new fits."""

Tell = Callable[[str], None]


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


def search(
    base: Trial, effects: Sequence[str], most: int, rng: np.random.Generator, tell: Tell
) -> Search:
    """Add effects to the base until what is left is noise, none gains enough, or there are most.

    Parameters
    ----------
    base
        The fitted base model.
    effects
        Names of the candidates.
    most
        Most effects of a model.
    rng
        Source of the draws of noise.
    tell
        Is told what goes on.
    """
    spare = 2.0 * float(np.log(max(len(effects), 1)))
    first = _sharp(_look(base, effects, rng), rng)
    best, best_alarm, rounds = first.start, first.alarm, [first]
    if first.alarm.silent:
        return Search((first,), best, best_alarm, spare)
    rounds = [replace(first, trials=_singles(first, tell))]
    beam = _claims(rounds, spare)
    while beam:
        steps = [_onwards(beam[0], effects, rng)]
        if best.penalised - beam[0].penalised >= spare:
            best, best_alarm = steps[0].start, steps[0].alarm
        if best_alarm.silent or len(best.effects) >= most:
            break
        steps += [_onwards(trial, effects, rng) for trial in beam[1:]]
        steps = [replace(step, trials=_more(step, tell)) for step in steps]
        rounds += steps
        beam = _claims(steps, spare)
    return Search(tuple(rounds), best, best_alarm, spare)


def _onwards(trial: Trial, effects: Sequence[str], rng: np.random.Generator) -> Round:
    start = replace(trial, fit=refreshed(trial.model, trial.fit))
    return _look(start, [effect for effect in effects if effect not in trial.effects], rng)


def _sharp(step: Round, rng: np.random.Generator) -> Round:
    """Return the first look with a noise that does not count the misfit of the base as noise.

    The noise is estimated again about the most promising models with one effect.
    """
    if step.alarm.silent and not blurred(step.start.model.base):
        return step
    order = sorted(step.looks, key=lambda look: float(look.ahead.min()))[:LEADING]
    best = min((with_effect(step.start, look) for look in order), key=lambda t: t.fit.chi2)
    base = with_noise_about(best)
    if clearer(best.model.base, base) < CLEARER:
        return step
    start = refitted(step.start, base)
    return _look(start, [look.effect for look in step.looks], rng)


def _look(trial: Trial, effects: Sequence[str], rng: np.random.Generator) -> Round:
    looks = look_at(trial, effects)
    return Round(trial, alarm(trial.model, trial.fit, looks, rng), tuple(looks))


def _singles(step: Round, tell: Tell) -> tuple[Trial, ...]:
    """Fit every effect alone, then the leading ones that have several forms in these."""
    trials = _polished(_fitted(step, len(step.looks), tell))
    catalogue = known_effects()
    leading = [trial for trial in trials if catalogue[trial.effects[-1]].form][:FORMED]
    return _sorted([*trials, *_forms(leading, tell)])


def _fitted(step: Round, most: int, tell: Tell) -> list[Trial]:
    """Fit one effect more, those that promise most first."""
    trials: list[Trial] = []
    best = np.inf
    for look in sorted(step.looks, key=lambda look: float(look.ahead.min()))[:most]:
        trials.append(with_effect(step.start, look, best))
        best = min(best, trials[-1].fit.chi2)
        tell(f"{' + '.join(trials[-1].effects)}: chi-square {trials[-1].fit.chi2:.1f}")
    return trials


def _forms(leading: Sequence[Trial], tell: Tell) -> list[Trial]:
    """Fit the last effect of each model with each of its form parameters free."""
    catalogue = known_effects()
    found = []
    for trial in leading:
        effect = trial.effects[-1]
        for parameter in catalogue[effect].form:
            found.append(with_form(trial, effect, parameter))
            tell(f"{effect}, {parameter} free: chi-square {found[-1].fit.chi2:.1f}")
    return found


def _more(step: Round, tell: Tell) -> tuple[Trial, ...]:
    """Fit one effect more, those that promise most."""
    trials = _polished(_fitted(step, BRANCHES, tell))
    return _sorted([*trials, *_forms(trials[:1], tell)])


def _polished(trials: Sequence[Trial]) -> list[Trial]:
    """Return the trials in order, the leading ones searched on from elsewhere."""
    order = _sorted(trials)
    return list(_sorted([*map(polished, order[:POLISHED]), *order[POLISHED:]]))


def _sorted(trials: Sequence[Trial]) -> tuple[Trial, ...]:
    return tuple(sorted(trials, key=lambda trial: trial.penalised))


def _claims(steps: Sequence[Round], spare: float) -> list[Trial]:
    """Return the best trials that gain enough over the model they started from."""
    found = [
        trial
        for step in steps
        for trial in step.trials
        if step.start.penalised - trial.penalised >= spare
    ]
    return sorted(found, key=lambda trial: trial.penalised)[:BEAM]


def dropped(trial: Trial, effect: str) -> Trial:
    """Fit the model without one of its effects, from where it stands."""
    base: Base = trial.model.base
    free = {name: of for name, of in trial.model.effects.items() if name != effect}
    model = model_of(base, free, trial.model.channels)
    keep = [i for i, name in enumerate(trial.model.names) if name in model.names]
    return Trial(model, refreshed(model, descend(model, trial.fit.x[keep])))
