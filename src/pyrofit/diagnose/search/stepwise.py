"""The search: every effect alone, the leading ones in other forms, then pairs, then three."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.diagnose.base.adequacy import LackOfFit, lack_of_fit
from pyrofit.diagnose.base.descent import Fit, descend, refreshed
from pyrofit.diagnose.base.fit import blurred, clearer, refitted, with_noise_about
from pyrofit.diagnose.base.fitted import FittedModel, at_limit, up_to_date
from pyrofit.diagnose.base.model import Base, model_of
from pyrofit.diagnose.search.refit import look_at, model_with, with_effect
from pyrofit.diagnose.search.step import SearchContext, SearchStep, in_order, more, singles
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.parallel import parallel_map


@dataclass(frozen=True, eq=False)
class Search:
    """All rounds in order, and the model they end with: the base itself, or one with effects."""

    rounds: tuple[SearchStep, ...]
    end: FittedModel
    end_lack: LackOfFit
    spare: float
    """2 log(M): what the penalised chi-square must fall by to claim one of M effects, so that
    chi-square falls by log(n) + 2 log(M) (Chen and Chen 2008, doi 10.1093/biomet/asn034)."""

    @property
    def base(self) -> FittedModel:
        """The base model's fit."""
        return self.rounds[0].start

    @property
    def trials(self) -> list[FittedModel]:
        """All fits with effects."""
        return [trial for step in self.rounds for trial in step.trials]


def search(base: FittedModel, effects: Sequence[str], most: int, means: SearchContext) -> Search:
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
    off = found.end.fit.chi2 > SETTINGS.misfit_chi2_per_point * found.end.model.points
    if found.end_lack.adequate or not found.end.effects or off:
        return found
    sharper = with_noise_about(found.end, processes=means.processes)
    if clearer(found.end.model.base, sharper) < SETTINGS.clearer_bic:
        return found
    means.tell("once more, with the noise about the best model")
    return _search(refitted(found.base, sharper), effects, most, means)


def _search(base: FittedModel, effects: Sequence[str], most: int, means: SearchContext) -> Search:
    spare = 2.0 * float(np.log(max(len(effects), 1)))
    first = _sharp(_look(base, effects, means), means)
    best, best_alarm, rounds = first.start, first.lack, [first]
    if first.lack.passes:
        return Search((first,), best, best_alarm, spare)
    rounds = [replace(first, trials=singles(first, means))]
    beam = _claims(rounds, spare)
    while beam:
        steps = [_onwards(beam[0], effects, means)]
        added = len(beam[0].effects) - len(best.effects)
        if best.penalised - beam[0].penalised >= added * spare:
            best, best_alarm = steps[0].start, steps[0].lack
        if best_alarm.passes or len(beam[0].effects) >= most:
            break
        steps += [_onwards(trial, effects, means) for trial in beam[1:]]
        # The best may get any effect more; the other those that promise most.
        steps = [
            replace(
                step,
                trials=more(
                    step, SETTINGS.candidates_of_second_branch if i else len(effects), means
                ),
            )
            for i, step in enumerate(steps)
        ]
        rounds += steps
        beam = _claims(steps, spare)
    return Search(tuple(rounds), best, best_alarm, spare)


def _onwards(trial: FittedModel, effects: Sequence[str], means: SearchContext) -> SearchStep:
    return _look(
        up_to_date(trial), [effect for effect in effects if effect not in trial.effects], means
    )


def _sharp(step: SearchStep, means: SearchContext) -> SearchStep:
    """Return the first look with a noise that does not count the misfit of the base as noise.

    The noise is estimated again about the most promising models with one effect.
    """
    if step.lack.passes and not blurred(step.start.model.base):
        return step
    order = sorted(step.looks, key=lambda look: float(look.ahead.min()))[: SETTINGS.noise_leaders]
    if not order:
        return step
    fits = parallel_map(
        lambda i: with_effect(step.start, order[i]).fit, len(order), means.processes
    )
    at = int(np.argmin([fit.chi2 for fit in fits]))
    best = FittedModel(model_with(step.start, order[at].effect), fits[at])
    base = with_noise_about(best, processes=means.processes)
    if clearer(best.model.base, base) < SETTINGS.clearer_bic:
        return step
    start = refitted(step.start, base)
    return _look(start, [look.effect for look in step.looks], means)


def _look(trial: FittedModel, effects: Sequence[str], means: SearchContext) -> SearchStep:
    looks = look_at(trial, effects, means.processes)
    directions = [look.directions for look in looks]
    return SearchStep(
        trial,
        lack_of_fit(trial.model, trial.fit, directions, means.rng, means.processes),
        tuple(looks),
    )


def _claims(steps: Sequence[SearchStep], spare: float) -> list[FittedModel]:
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
    best: dict[frozenset[str], FittedModel] = {}
    for trial in in_order(inside or found):
        best.setdefault(frozenset(trial.effects), trial)
    leading = list(best.values())[: SETTINGS.branches]
    return [
        trial
        for trial in leading
        if trial.fit.chi2 <= SETTINGS.far_chi2_ratio * leading[0].fit.chi2
    ]


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
