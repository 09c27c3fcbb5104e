"""The verdict: the effects that may be claimed after the search, and how surely."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel, up_to_date
from pyrofit.diagnose.judge.doubts import (
    effect_title,
    hardly_agreeing,
    infirm,
    open_to_terms,
    outvoted,
    replaceable,
    still_missed,
    unconfirmed,
)
from pyrofit.diagnose.judge.findings import Finding, Verdict
from pyrofit.diagnose.judge.inflation import inflation_by_misfit
from pyrofit.diagnose.judge.other_terms import other_terms
from pyrofit.diagnose.judge.places import end_without_superfluous, findings_of, with_end
from pyrofit.diagnose.search.refit import look_at
from pyrofit.diagnose.search.step import SearchContext
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.model.slab import SlabExperiment
from pyrofit.results.diagnosis_schema import Kind, OfSuspect

ONE_FLUX = "only the mass loss rate at one flux is calibrated"
"""A reason that leaves every claim open."""

FITS = "no test of the residuals shows a lack of fit"
"""Start of the reason for the verdict `none`."""


def judge(found: Search, rng: np.random.Generator, processes: int = 1) -> Verdict:
    """Return the verdict on a search's final model.

    Parameters
    ----------
    rng
        Source of the draws of noise that held-out signals are compared with.
    processes
        Processes that share the fits.
    """
    if not found.end.effects:
        return _without_effects(found)
    context = SearchContext(rng, processes=processes)
    found, without = end_without_superfluous(found, context)
    part, failed = (None, []) if found.end_lack.adequate else _partly(found, without, context)
    if part:
        return part
    findings = findings_of(found, without, context)
    reasons = _reasons(findings)
    if len(findings) == 1 and reasons and findings[0].kept:
        # The best one fails, another does not: the verdict is about that one.
        found, reasons = with_end(found, findings[0].kept[0].trial, rng), []
        (of_end,) = findings_of(found, without, context)
        findings = (replace(findings[0], instead=of_end.instead),)
    elif reasons and found.end_lack.adequate:
        part, _ = _partly(found, without, context)
        if part:
            return part
    if not found.end_lack.adequate:
        reasons = [f"{effect_title(effect)}: {why}" for effect, why in failed] or reasons
        reasons.append("the residuals exceed the noise, with every effect that gains enough")
    of_base = found.rounds[0].lack()
    if reasons and of_base.passes:
        found = replace(found, end=found.base, end_lack=of_base)
        said = f"{FITS}, and no effect passes every test of a claim"
        return Verdict("none", found, (), (said, *reasons))
    if reasons:
        return Verdict("unknown", found, findings, tuple(reasons))
    return _explained(found, findings, without, processes)


def _explained(
    found: Search,
    findings: Sequence[Finding],
    without: Sequence[FittedModel],
    processes: int,
) -> Verdict:
    """Return the verdict on effects that leave nothing but noise."""
    if all(finding.agreed for finding in findings):
        findings = _with_other_terms(found, findings, without, processes)
    doubts = tuple(doubts_of(found, findings))
    kind: Kind = "multiple" if len(findings) > 1 else "named"
    if ONE_FLUX in doubts or (kind == "named" and not findings[0].sure):
        kind = "ambiguous"
    return Verdict(kind, found, tuple(findings), doubts or tuple(map(_support, findings)))


def _support(finding: Finding) -> str:
    """State the evidence for an effect that no doubt is left about."""
    rise = sum(finding.kept[0].trust.gains.values())
    said = f", and the log score of predictions rises by {rise:.1f}" if rise else ""
    return f"{effect_title(finding.leading)} passes every test of a claim{said}"


def _with_other_terms(
    found: Search,
    findings: Sequence[Finding],
    without: Sequence[FittedModel],
    processes: int,
) -> list[Finding]:
    """Return findings with the free corrections that were fitted in their places."""
    others = other_terms(up_to_date(found.end), without, inflation_by_misfit(found), processes)
    return [
        replace(finding, others=tuple(terms))
        for finding, terms in zip(findings, others, strict=True)
    ]


def _reasons(findings: Sequence[Finding]) -> list[str]:
    first = [(finding.effect, finding.judged[0].rejected) for finding in findings]
    return [f"{effect_title(effect)}: {rejected}" for effect, rejected in first if rejected]


def _partly(
    found: Search, without: Sequence[FittedModel], context: SearchContext
) -> tuple[Verdict | None, list[tuple[str, str]]]:
    """Return the verdict on the effects that pass every test, if any, and why others do not.

    Effects that fail a test are taken away one by one, the one that gains least first; the others
    are judged again. They usually explain a part only. None is claimed where all together leave
    nothing but noise: if one of these fails, the others may stand for a missing effect as well.
    """
    all_fit, processes = found.end_lack.adequate, context.processes
    taken_away: list[tuple[str, str]] = []
    while True:
        findings, against = _judged_beside_misfit(found, without, context)
        if not against:
            break
        position, reason = against
        taken_away.append((found.end.effects[position], reason))
        if len(without) == 1:
            return None, taken_away
        found, without = end_without_superfluous(
            with_end(found, without[position], context.rng), context
        )
        if all_fit and not found.end_lack.adequate:
            return None, taken_away
    if found.end_lack.adequate:
        return _explained(found, findings, without, processes), taken_away
    if ONE_FLUX in doubts_of(found, findings):
        return None, taken_away
    suspects = _suspects(found, processes)
    part = Verdict("partly", found, findings, (_rest(found),), suspects, tuple(taken_away))
    return part, taken_away


def _judged_beside_misfit(
    found: Search, without: Sequence[FittedModel], context: SearchContext
) -> tuple[tuple[Finding, ...], tuple[int, str] | None]:
    """Return the findings, or position and reason of the effect that fails a test.

    Of several that fail it is the one that gains least. The effects are judged in this order, as
    predictions of the others may not be needed.
    """
    penalised, beside_misfit = inflation_by_misfit(found).penalised, not found.end_lack.adequate
    for k in sorted(range(len(without)), key=lambda k: penalised(without[k])):
        (finding,) = findings_of(found, without, context, [k], leading_first=True)
        if reason := _against(finding, beside_misfit):
            return (), (k, reason)
    findings = findings_of(found, without, context)
    if beside_misfit:
        findings = tuple(_with_other_terms(found, findings, without, context.processes))
        for k, finding in enumerate(findings):
            if finding.open_terms:
                return (), (k, open_to_terms(finding))
    return findings, None


def _rest(found: Search) -> str:
    """Say in which signals the final model leaves more than noise."""
    lack, problem = found.end_lack, found.end.model.likelihood.problem
    signals: dict[str, list[str]] = {}
    for name, signal in dict.fromkeys(problem.picks[window.channel][:2] for window in lack.windows):
        experiment = problem.runs[name].experiment
        signals.setdefault(experiment.title or name, []).append(experiment.words(signal))
    if not signals:
        return (
            f"part of the misfit remains: chi-square is {lack.chi2:.4g} of {lack.chi2_critical:.4g}"
        )
    places = (f"{title} ({', '.join(words)})" for title, words in signals.items())
    return f"part of the misfit remains: {'; '.join(places)}"


def _against(finding: Finding, beside_misfit: bool) -> str:
    """Say why the leading effect is not claimed, or nothing.

    It must pass every test, and all that fit as well must agree with it. Beside other misfit
    nothing may speak against it: an effect that stands for another one explains a part, too.
    """
    first = finding.judged[0]
    if first.rejected:
        return first.rejected
    if not finding.group:
        return finding.open_words
    doubts = [unconfirmed(j) for j in finding.kept if not j.trust.confirmed][:1]
    doubts += infirm(finding)
    if beside_misfit:
        doubts += [*outvoted(finding.kept), *replaceable([finding]), *hardly_agreeing(finding)]
        doubts += still_missed(finding)
    return ". ".join([*doubts[:1], *(f"{said[0].upper()}{said[1:]}" for said in doubts[1:])])


def _suspects(found: Search, processes: int) -> tuple[OfSuspect, ...]:
    """Return the candidates that promise to explain most of the final model's misfit."""
    names = [look.effect for look in found.rounds[0].looks if look.effect not in found.end.effects]
    looks = look_at(found.end, names, processes)
    chi2 = found.end.fit.chi2
    gains = [OfSuspect(effect=k.effect, gain=chi2 - float(k.ahead.min())) for k in looks]
    most = found.end.settings.most_suspects
    leading = sorted(gains, key=lambda suspect: -suspect.gain)[:most]
    return tuple(suspect for suspect in leading if suspect.gain > found.spare)


def _without_effects(found: Search) -> Verdict:
    if found.end_lack.adequate:
        tests = f"{FITS}, and" if found.end_lack.passes else "a score test is significant, but"
        reason = f"{tests} no effect lowers chi-square enough for a claim"
        gains = [s.start.penalised - t.penalised for s in found.rounds for t in s.trials]
        if max(gains, default=0.0) >= found.spare:
            reason = "held-out runs do not finish with any effect that gains enough"
        return Verdict("none", found, (), (reason,))
    return Verdict("unknown", found, (), ("no effect of the catalogue gains enough",))


def doubts_of(found: Search, findings: Sequence[Finding]) -> list[str]:
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
        doubts.append("the model does not explain held-out signals, even if they are fitted too")
    kept = [judged for finding in findings for judged in finding.kept]
    doubts += map(unconfirmed, (j for j in kept if not (j.trust.outvoted or j.trust.confirmed)))
    doubts += outvoted(kept)
    open_terms = [open_to_terms(finding) for finding in findings if finding.open_terms]
    if open_terms:
        doubts += [*open_terms, "the reason may be an effect outside the catalogue"]
    doubts += replaceable(findings)
    doubts += [words for finding in findings for words in infirm(finding)]
    open_ones = [finding for finding in findings if not finding.group]
    return doubts + [finding.open_words for finding in open_ones]
