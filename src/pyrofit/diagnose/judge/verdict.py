"""The verdict: what of the search may be claimed, and how surely."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.adequacy import lack_of_fit
from pyrofit.diagnose.base.fitted import FittedModel, at_limit, up_to_date
from pyrofit.diagnose.judge.claim_tests import HELD_OUT, Trust, explains, predictions, trust
from pyrofit.diagnose.judge.findings import Finding, Judged, Kind, Verdict
from pyrofit.diagnose.search.step import SearchStep
from pyrofit.diagnose.search.stepwise import Search, dropped
from pyrofit.diagnose.settings import SETTINGS
from pyrofit.model.slab import SlabExperiment
from pyrofit.parallel import parallel_map

ONE_FLUX = "only the mass loss rate at one flux is calibrated"
"""A reason that leaves every claim open."""


def judge(found: Search, rng: np.random.Generator, processes: int = 1) -> Verdict:
    """Return what may be claimed of a search's end.

    Parameters
    ----------
    rng
        Source of the draws of noise that what is held out is compared with.
    processes
        Processes that share the fits.
    """
    if not found.end.effects:
        return _without_effects(found)
    found, without = _needed(found, rng, processes)
    findings = _findings(found, without, rng, processes)
    reasons = [f"{f.effect}: {j.rejected}" for f in findings for j in f.judged[:1] if j.rejected]
    if len(findings) == 1 and reasons and findings[0].kept:
        # The best one fails, another does not: the verdict is about that one.
        found, reasons = _ended(found, findings[0].kept[0].trial, rng), []
    if not found.end_lack.adequate:
        reasons.append("what is left is more than noise, with every effect that gains enough")
    if reasons:
        return Verdict("unknown", found, findings, tuple(reasons))
    doubts = tuple(_doubts(found, findings))
    kind: Kind = "multiple" if len(findings) > 1 else "named"
    if ONE_FLUX in doubts or (kind == "named" and not findings[0].sure):
        kind = "ambiguous"
    return Verdict(kind, found, findings, doubts)


def _without_effects(found: Search) -> Verdict:
    if found.end_lack.passes:
        return Verdict("none", found, (), ("what is left is noise",))
    if found.end_lack.adequate:
        reason = "an effect's score is remarkable, but none gains enough to be claimed"
        return Verdict("none", found, (), (reason,))
    return Verdict("unknown", found, (), ("no effect of the catalogue gains enough",))


def _needed(
    found: Search, rng: np.random.Generator, processes: int
) -> tuple[Search, list[FittedModel]]:
    """End a search without the effects that others make superfluous, the least one first.

    Returns the search, and the best model without each of the effects that are left.
    """
    without = _without(found, processes)
    while len(without) > 1:
        least = min(without, key=lambda trial: trial.penalised)
        if least.penalised - found.end.penalised >= found.spare:
            break
        found = _ended(found, least, rng)
        without = _without(found, processes)
    if not any(_same(trial, found.end) for trial in found.trials):
        step = SearchStep(without[0], found.end_lack, (), (found.end,))
        found = replace(found, rounds=(*found.rounds, step))
    return found, without


def _without(found: Search, processes: int) -> list[FittedModel]:
    """Return the best model without each effect of a search's end: as dropped, or as at hand."""
    dropped_ones = dropped(found.end, found.end.effects, processes)
    at_hand = [found.base, *found.trials]
    return [
        up_to_date(min([one, *(t for t in at_hand if _same(t, one))], key=lambda t: t.fit.chi2))
        for one in dropped_ones
    ]


def _same(trial: FittedModel, other: FittedModel) -> bool:
    return dict(trial.model.effects) == dict(other.model.effects)


def _ended(found: Search, end: FittedModel, rng: np.random.Generator) -> Search:
    """Return a search with another end."""
    return replace(found, end=end, end_lack=lack_of_fit(end.model, end.fit, [], rng))


def _doubts(found: Search, findings: Sequence[Finding]) -> list[str]:
    """Say why a claim is less than sure."""
    doubts = []
    base = found.base.model.base
    runs = base.likelihood.problem.runs
    shown = [(runs[name].experiment, s) for name, s in (base.channels[i] for i in base.calibrated)]
    slabs = [(e, signal) for e, signal in shown if isinstance(e, SlabExperiment)]
    fluxes = {str(e.front.flux_W_m2) for e, _ in slabs}
    if len(fluxes) == 1 and not any(e.quantity(signal).is_temperature for e, signal in slabs):
        doubts.append(ONE_FLUX)
    if not all(finding.explains for finding in findings):
        doubts.append("what is held out is not explained, not even if it is fitted, too")
    kept = [judged for finding in findings for judged in finding.kept]
    return doubts + [_unconfirmed(judged) for judged in kept if not judged.trust.confirmed]


def _unconfirmed(judged: Judged) -> str:
    if not judged.trust.predicts:
        return f"{judged.effect}: no prediction confirms it clearly"
    gain = judged.trust.gains[HELD_OUT]
    return (
        f"{judged.effect}: the log score of what is held out gains {gain:+.1f} only; "
        f"{SETTINGS.informative_gain:g} at least is asked for"
    )


def _findings(
    found: Search, without: Sequence[FittedModel], rng: np.random.Generator, processes: int
) -> tuple[Finding, ...]:
    """Judge each effect of a search's end, and those that it cannot be told from.

    ``without`` are the models without each of them.
    """
    effects = found.end.effects
    places = [alternatives(found, effect) for effect in effects]
    # The end of the search has a place among the rivals of each of its effects.
    rivals = {_key(trial): trial for place in places for _, trial in place}
    predicted = predictions([*without, *rivals.values()], processes)
    before, own = predicted[: len(without)], predicted[len(without) :]
    rngs = rng.spawn(len(own))
    explained = parallel_map(lambda i: explains(own[i], rngs[i]), len(own), processes)
    known = dict(zip(rivals, zip(own, explained, strict=True), strict=True))

    def judged(name: str, trial: FittedModel, k: int) -> Judged:
        foreseen, also = known[_key(trial)]
        about = trust(trial, name, foreseen, before[k], also)
        if trial is not places[k][0][1]:  # the end's other effects have places of their own
            limits = filter(None, (at_limit(trial, effect) for effect in trial.effects))
            about = replace(about, limit=next(limits, ""))
        gain = without[k].penalised - trial.penalised
        return Judged(name, trial, about, _against(gain, found.spare, about))

    return tuple(
        Finding(effect, tuple(judged(name, trial, k) for name, trial in places[k]))
        for k, effect in enumerate(effects)
    )


def _key(trial: FittedModel) -> tuple[tuple[str, tuple[str, ...]], ...]:
    return tuple(trial.model.effects.items())


def alternatives(found: Search, effect: str) -> list[tuple[str, FittedModel]]:
    """Return the models with another effect in one's place that cannot be told from the best.

    Of each effect the best form; the end of the search itself first.
    """
    others = set(found.end.effects) - {effect}
    best = {effect: found.end}
    for trial in sorted(found.trials, key=lambda trial: trial.penalised):
        (*rest,) = set(trial.effects) - others
        same = others <= set(trial.effects) and len(rest) == 1
        if same and trial.penalised <= found.end.penalised + SETTINGS.ambiguous_chi2:
            best.setdefault(rest[0], trial)
    return [(name, up_to_date(trial)) for name, trial in list(best.items())[: SETTINGS.most_judged]]


def _against(gain: float, spare: float, about: Trust) -> str:
    """Say what speaks against a model, nothing where it passes.

    ``gain`` is that of penalised chi-square over the model without the effect.
    """
    if gain < spare:
        return f"gains {gain:.1f} of penalised chi-square, {spare:.1f} are asked for"
    if about.limit:
        return f"{about.limit} rests at a limit"
    if about.disagree < SETTINGS.agreement_level:
        return f"the experiments ask for different strengths (p = {about.disagree:.1g})"
    if about.informative and not about.predicts:
        worst = min(about.gains, key=lambda name: about.gains[name])
        return (
            f"predictions do not improve: log score {about.gains[worst]:+.1f} for {worst}, "
            f"{sum(about.gains.values()):+.1f} in all; "
            f"{SETTINGS.informative_gain:g} at least is asked for"
        )
    return ""
