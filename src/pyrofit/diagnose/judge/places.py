"""The effects of the final model that are needed, and the evidence for and against each."""

import math
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.adequacy import lack_of_fit
from pyrofit.diagnose.base.fitted import FittedModel, finishes, strengths_at_limit, up_to_date
from pyrofit.diagnose.base.inflation import by_significant_misfit
from pyrofit.diagnose.base.prediction import model_predictions
from pyrofit.diagnose.judge.accord import conflicts, known_beside, wrong_instead
from pyrofit.diagnose.judge.claim_tests import Trust, explains, trust
from pyrofit.diagnose.judge.findings import Exchange, Finding, Judged
from pyrofit.diagnose.judge.inflation import inflation_by_misfit
from pyrofit.diagnose.judge.weights import group_weights
from pyrofit.diagnose.search.restart import refitted_without
from pyrofit.diagnose.search.step import SearchContext, SearchStep
from pyrofit.diagnose.search.stepwise import Search, replacing
from pyrofit.effects import known_effects
from pyrofit.parallel import parallel_map

Key = tuple[tuple[str, tuple[str, ...]], ...]
"""Effects of a model, with their forms."""


def end_without_superfluous(
    found: Search, context: SearchContext
) -> tuple[Search, list[FittedModel]]:
    """End a search without the effects that others make superfluous, the least one first.

    Returns the search, and the best model without each of the effects that are left.
    """
    without = without_each(found, context.processes)
    while len(without) > 1:
        penalised = inflation_by_misfit(found).penalised
        least = min(without, key=penalised)
        if penalised(least) - penalised(found.end) >= found.spare:
            break
        found = with_end(found, least, context.rng)
        without = without_each(found, context.processes)
    if not any(trial.key == found.end.key for trial in found.trials):
        lack = found.end_lack
        step = SearchStep(without[0], lambda: lack, (), (found.end,))
        found = replace(found, rounds=(*found.rounds, step))
    return found, without


def without_each(found: Search, processes: int) -> list[FittedModel]:
    """Return for each effect of the final model the best fit without it.

    It is fitted now, or was found by the search.
    """
    reduced = refitted_without(found.end, found.end.effects, processes)
    at_hand = [found.base, *found.trials]
    return [
        up_to_date(min([one, *(t for t in at_hand if t.key == one.key)], key=lambda t: t.fit.chi2))
        for one in reduced
    ]


def with_end(found: Search, end: FittedModel, rng: np.random.Generator) -> Search:
    """Return a search with another end."""
    return replace(found, end=end, end_lack=lack_of_fit(end.model, end.fit, [], rng))


def findings_of(
    found: Search,
    without: Sequence[FittedModel],
    context: SearchContext,
    which: Sequence[int] | None = None,
    leading_first: bool = False,
) -> tuple[Finding, ...]:
    """Judge effects of a search's end, all or which ones, and those they cannot be told from.

    ``without`` are the models without each effect of the end. With ``leading_first`` the others are
    not judged where the leading ones are all rejected.
    """
    effects = found.end.effects
    which = range(len(effects)) if which is None else which
    places = {k: alternatives(found, effects[k]) for k in which}
    exchanged = {k: exchanges(found, effects[k]) for k in which}
    # The end of the search has a place among the rivals of each of its effects.
    rivals = {_key(trial): trial for place in places.values() for _, trial in place}
    rivals |= {_key(one.trial): one.trial for place in exchanged.values() for one in place}
    # A model that leaves misfit explains no held-out signal.
    may_explain = found.end_lack.adequate or (
        len(effects) == 1 and not all(map(_leaves_misfit, rivals.values()))
    )
    rngs = dict(zip(rivals, context.rng.spawn(len(rivals)), strict=True)) if may_explain else {}
    if leading_first:
        firsts = {k: place[:1] for k, place in places.items()}
        alone = _judged(found, without, context, firsts, dict.fromkeys(which, ()), deepcopy(rngs))
        if all(finding.judged[0].rejected for finding in alone):
            return alone
    return _judged(found, without, context, places, exchanged, rngs)


def _leaves_misfit(trial: FittedModel) -> bool:
    return by_significant_misfit(trial).inflates


def _judged(
    found: Search,
    without: Sequence[FittedModel],
    context: SearchContext,
    places: Mapping[int, Sequence[tuple[str, FittedModel]]],
    exchanged: Mapping[int, Sequence[Exchange]],
    rngs: Mapping[Key, np.random.Generator],
) -> tuple[Finding, ...]:
    """Judge models in the places of effects, and in exchange for them.

    ``rngs`` draw the noise of held-out signals, by model; none where no model may explain them.
    """
    effects, processes = found.end.effects, context.processes
    pairs = [(k, trial) for k, place in places.items() for _, trial in place]
    pairs += [(k, one.trial) for k, place in exchanged.items() for one in place]
    rivals = {_key(trial): trial for _, trial in pairs}
    models = [*(without[k] for k in places), *rivals.values()]
    predicted = model_predictions(models, processes, whole=bool(rngs), made=context.made)
    before = dict(zip(places, predicted[: len(places)], strict=True))
    own = dict(zip(rivals, predicted[len(places) :], strict=True))
    explained: dict[Key, bool | None] = dict.fromkeys(rivals)
    if rngs:
        keys = list(rivals)
        tested = parallel_map(
            lambda i: not _leaves_misfit(rivals[keys[i]]) and explains(own[keys[i]], rngs[keys[i]]),
            len(keys),
            processes,
        )
        explained.update(zip(keys, tested, strict=True))
    inflation = inflation_by_misfit(found)
    beside = [(trial, without[k]) for k, trial in pairs]
    near = found.end.settings.ambiguous_chi2
    against = conflicts(beside, inflation.penalised, found.spare, processes)
    errors = wrong_instead(beside, inflation.penalised, near, processes)
    conflict = {(k, _key(trial)): names for (k, trial), names in zip(pairs, against, strict=True)}
    wrong = {(k, _key(trial)): names for (k, trial), names in zip(pairs, errors, strict=True)}

    def judged(name: str, key: Key, k: int) -> Judged:
        trial = rivals[key]
        about = trust(trial, name, own[key], before[k], explained[key], inflation, conflict[k, key])
        about = replace(
            about,
            known=known_beside(trial, without[k]),
            wrong_instead=tuple(wrong[k, key]),
        )
        if key != _key(places[k][0][1]):  # the end's other effects have places of their own
            about = replace(about, limit=next(iter(strengths_at_limit(trial)), ""))
        gain = inflation.penalised(without[k]) - inflation.penalised(trial)
        return Judged(name, trial, about, words_against(gain, found.spare, about))

    def passes(one: Exchange, k: int) -> bool:
        return not any(judged(name, _key(one.trial), k).rejected for name in one.by)

    weights, catalogue = group_weights(found), known_effects()
    return tuple(
        Finding(
            effects[k],
            tuple(judged(name, _key(trial), k) for name, trial in place),
            instead=tuple(one for one in exchanged[k] if passes(one, k)),
            weight=weights[catalogue[effects[k]].group],
        )
        for k, place in places.items()
    )


def _key(trial: FittedModel) -> Key:
    return tuple(trial.model.effects.items())


def alternatives(found: Search, effect: str) -> list[tuple[str, FittedModel]]:
    """Return the models with another effect in one's place that cannot be told from the best.

    Of each effect the best form; the end of the search itself first.
    """
    best, settings = {effect: found.end}, found.end.settings
    penalised = inflation_by_misfit(found).penalised
    near = penalised(found.end) + settings.ambiguous_chi2
    for name, trial in sorted(replacing(found, effect), key=lambda one: penalised(one[1])):
        if penalised(trial) <= near:
            best.setdefault(name, trial)
    return [(name, up_to_date(trial)) for name, trial in list(best.items())[: settings.most_judged]]


def exchanges(found: Search, effect: str) -> list[Exchange]:
    """Return the exchanges of an effect for two others, or of it and another one for one.

    Only those to models that cannot be told from the best, the best one of each. Of two others both
    must be needed.
    """
    end, penalised = found.end, inflation_by_misfit(found).penalised
    near = penalised(end) + end.settings.ambiguous_chi2
    best: dict[tuple[str, ...], Exchange] = {}
    for trial in sorted(found.trials, key=penalised):
        replaced = tuple(name for name in end.effects if name not in trial.effects)
        by = tuple(name for name in trial.effects if name not in end.effects)
        if effect not in replaced or {len(replaced), len(by)} != {1, 2} or replaced in best:
            continue
        if penalised(trial) <= near and _all_needed(found, trial, by) and finishes(trial):
            best[replaced] = Exchange(replaced, by, up_to_date(trial))
    return list(best.values())


def _all_needed(found: Search, trial: FittedModel, by: Sequence[str]) -> bool:
    """Tell whether no fit without one of several effects is nearly as good."""
    penalised = inflation_by_misfit(found).penalised
    smaller = [set(trial.effects) - {name} for name in by if len(by) > 1]
    enough = penalised(trial) + found.spare
    return not any(set(t.effects) in smaller and penalised(t) < enough for t in found.trials)


def words_against(gain: float, spare: float, about: Trust) -> str:
    """State the reason against a model, empty where it passes.

    ``gain`` is that of penalised chi-square over the model without the effect.
    """
    if gain < spare:
        return f"penalised gain {gain:.1f}; {spare:.1f} needed"
    if about.limit:
        return f"{about.limit} is at a limit"
    if about.conflict:
        return f"it gains only by moving {', '.join(about.conflict)} away from the known value"
    if about.disagree is not None and about.disagree < about.settings.agreement_level:
        return f"the experiments ask for different strengths (p = {about.disagree:.1g})"
    if about.informative and not about.predicts:
        gains = about.telling
        worst = min(about.worse or gains, key=lambda name: gains[name])
        if math.isinf(about.powers.get(worst, 0.0)):
            return f"its predictions cannot be compared: a run of {worst} does not finish"
        return (
            f"predictions do not improve: log score {gains[worst]:+.1f} for {worst}, "
            f"{sum(gains.values()):+.1f} in all; "
            f"{about.settings.informative_gain:g} at least is asked for"
        )
    return ""
