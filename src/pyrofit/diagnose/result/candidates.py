"""Candidates of a diagnosis as `diagnosis.json` holds them."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from pyrofit.diagnose.base.fitted import FittedModel, Key, finishes, strengths_at_limit
from pyrofit.diagnose.base.model import strength_of
from pyrofit.diagnose.judge.final_fits import FinalFits
from pyrofit.diagnose.judge.findings import Judged, Verdict
from pyrofit.diagnose.judge.intervals import ridges, strengths, wide_intervals, with_all_forms
from pyrofit.diagnose.search.score_test import confusability
from pyrofit.diagnose.search.step import SearchStep
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.effects import known_effects
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.results.diagnosis_schema import OfConfusability, OfScreen


def screened(found: Search) -> list[OfScreen]:
    """Return the score test of every candidate on the base model, the strongest first."""
    catalogue = known_effects()
    rows = []
    for look in found.rounds[0].looks:
        effect = catalogue[look.effect]
        _, quantity = strength_of(look.effect)
        row = OfScreen(
            effect=look.effect,
            group=effect.group,
            family=effect.family,
            detectability=look.detectability,
            typical=quantity.typical,
            unit=quantity.unit,
            z=look.score(found.base.fit.residuals),
            ahead=max(0.0, found.base.fit.chi2 - float(look.ahead.min())),
        )
        rows.append(row)
    return sorted(rows, key=lambda row: -row.z)


def confusability_of(found: Search) -> OfConfusability:
    """Return how alike the signatures of the candidates are."""
    looks = list(found.rounds[0].looks)
    cosine = confusability(looks) if looks else np.zeros((0, 0))
    return OfConfusability(effects=[look.effect for look in looks], cosine=cosine.tolist())


def candidate_records(
    found: Search, verdict: Verdict, final: FinalFits, processes: int = 1
) -> list[OfCandidate]:
    """Return every fitted model with its effects, and why it is not the verdict's."""
    judged = verdict.judged
    leading = [final.fits[key] for key in final.leading]
    formed = dict(zip(final.leading, with_all_forms(leading, processes), strict=True))
    wide = wide_intervals([*leading, *(model for of in formed.values() for model in of.values())])
    best = found.end.penalised
    rows = []
    for step, trial in models(found):
        here = judged.get(trial.key, [])
        trial = here[0].trial if here else trial
        fit = final.of(trial) if here else trial
        is_leading = bool(here) and trial.key in formed
        judgement = _judgement(here)
        row = OfCandidate(
            effects=list(trial.effects),
            free={name: list(free) for name, free in trial.model.effects.items()},
            chi2=trial.fit.chi2,
            gain=step.start.fit.chi2 - trial.fit.chi2,
            penalised=trial.penalised,
            parameters=strengths(fit, wide if is_leading else {}),
            ridges=ridges(fit, formed[trial.key]) if is_leading else [],
            adequate=found.end_lack.adequate if trial.key == found.end.key else None,
            disagree=judgement.disagree,
            predictions=dict(judgement.predictions),
            explains=judgement.explains,
            rejected=judgement.rejected if here else _why_not(found, step.start, trial, best),
        )
        rows.append(row)
    return rows


def models(found: Search) -> list[tuple[SearchStep, FittedModel]]:
    """Return all fits, the best penalised chi-square first, each model once.

    Two effects are fitted twice, where each of them was carried on.
    """
    fits = [(step, trial) for step in found.rounds for trial in step.trials]
    models: dict[Key, tuple[SearchStep, FittedModel]] = {}
    for step, trial in sorted(fits, key=lambda fit: fit[1].penalised):
        models.setdefault(trial.key, (step, trial))
    return list(models.values())


class _Judgement(NamedTuple):
    """The findings on a model."""

    disagree: float | None = None
    predictions: Mapping[str, float] = MappingProxyType({})
    explains: bool | None = None
    rejected: str = ""


def _judgement(judged: list[Judged]) -> _Judgement:
    """Return the findings on a model, in all its effects' places."""
    if not judged:
        return _Judgement()
    against = dict.fromkeys(f"{j.effect}: {j.rejected}" for j in judged if j.rejected)
    tested = [j.trust.explains for j in judged]
    return _Judgement(
        disagree=min(
            (p for p in (j.trust.disagree for j in judged) if p is not None), default=None
        ),
        predictions=min((j.trust.gains for j in judged), key=lambda g: sum(g.values())),
        explains=None if None in tested else all(tested),
        rejected="; ".join(against),
    )


def _why_not(found: Search, start: FittedModel, trial: FittedModel, best: float) -> str:
    if trial.penalised < best and not finishes(trial):
        return "the simulation of a held-out test fails"
    gain = start.penalised - trial.penalised
    if gain < found.spare:
        return f"penalised gain {gain:.1f}; {found.spare:.1f} needed"
    limits = strengths_at_limit(trial)
    if limits:
        return f"{limits[0]} is at a limit"
    above = trial.penalised - best
    others = [name for name in trial.effects if name not in found.end.effects]
    if above < 0.0 and others:
        return f"fits better, but fails the tests of a claim with {', '.join(others)}"
    return f"{above:.1f} above the final model"
