"""Every kind of verdict, from searches on linear models whose truth is planted; and its words."""

from dataclasses import replace
from typing import Any

import linear
import numpy as np
import pytest
from linear import POINTS, TOTAL, column_of, fit_with, moved

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import name_of, strength_of
from pyrofit.diagnose.base.prediction import HELD_OUT
from pyrofit.diagnose.diagnosis import undecided_models
from pyrofit.diagnose.judge import other_terms, places
from pyrofit.diagnose.judge import verdict as judging
from pyrofit.diagnose.judge.claim_tests import Trust
from pyrofit.diagnose.judge.final_fits import final_fits
from pyrofit.diagnose.judge.findings import Judged, Verdict
from pyrofit.diagnose.judge.other_terms import OtherTerm
from pyrofit.diagnose.judge.places import alternatives, exchanges, without_each, words_against
from pyrofit.diagnose.judge.verdict import ONE_FLUX, doubts_of, judge
from pyrofit.diagnose.result.candidates import candidate_records
from pyrofit.diagnose.result.verdict_text import form_words, sentences
from pyrofit.diagnose.search import step_start
from pyrofit.diagnose.search.step import SearchContext
from pyrofit.diagnose.search.step_start import step_from as look_first
from pyrofit.diagnose.search.stepwise import Pass as Pass
from pyrofit.diagnose.search.stepwise import Search, search_effects
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.results.diagnosis_candidates import OfCandidate
from pyrofit.solver.arrays import FloatArray

EFFECTS = ("back_loss", "c_T", "heater_ramp", "k_T", "time_offset")
COLUMNS = linear.random_columns(6, *EFFECTS, size=60.0)
ALL, MLR_25 = (0, 1, 2, 3), (0,)


@pytest.fixture(autouse=True)
def no_corrections(monkeypatch: pytest.MonkeyPatch) -> None:
    """Free corrections change the description, which linear models do not have."""
    monkeypatch.setattr(other_terms, "fitted_corrections", lambda trial: [])


def planted(seed: int = 1, **typical: float) -> FloatArray:
    """Return noise and a truth with effects, in fractions of the typical distance from null."""
    y = np.random.default_rng(seed).standard_normal(TOTAL)
    y = y + 2.0 * COLUMNS["rho"] - COLUMNS["k"]
    for effect, share in typical.items():
        q = strength_of(effect)[1]
        y = y + (q.value + share * (q.typical - q.value)) * column_of(COLUMNS, effect)
    return np.asarray(y)


def searched(
    y: FloatArray,
    columns: linear.Columns = COLUMNS,
    effects: tuple[str, ...] = ("c_T", "heater_ramp", "k_T"),
    calibrated: tuple[int, ...] = ALL,
    most: int = 3,
) -> Search:
    trial = linear.fit(columns, y, calibrated=calibrated)
    return search_effects(
        trial, effects, most, SearchContext(np.random.default_rng(1), lambda text: None)
    )


def verdict_on(found: Search) -> Verdict:
    verdict = judge(found, np.random.default_rng(2))
    assert verdict.reasons, "every verdict has a reason"
    return verdict


def listed(found: Search) -> list[OfCandidate]:
    """Return the rows of the candidates that the verdict on a search leaves."""
    verdict = verdict_on(found)
    return candidate_records(found, verdict, final_fits(verdict, None))


def alike(effect: str, other: str, share: float = 0.01) -> dict[str, FloatArray]:
    """Return columns in which another effect does nearly the same as one."""
    q, p = strength_of(effect)[1], strength_of(other)[1]
    scale = (q.typical - q.value) / (p.typical - p.value)
    nearly = (1.0 - share) * column_of(COLUMNS, effect) * scale + share * column_of(COLUMNS, other)
    return {**COLUMNS, linear.strength_name(other): nearly}


# --- none -----------------------------------------------------------------------------------


def test_nothing_planted_is_none() -> None:
    found = searched(planted())
    verdict = verdict_on(found)
    assert verdict.kind == "none"
    assert verdict.findings == ()
    assert found.end_lack.passes
    assert {trial.effects for trial in found.trials} == {("c_T",), ("heater_ramp",), ("k_T",)}
    assert "These data show no missing effect. No test of the residuals" in sentences(verdict)


def test_claim_that_fails_where_the_base_fits_is_none() -> None:
    found = searched(planted())
    (best, *_) = found.trials
    verdict = verdict_on(replace(found, end=best))
    assert verdict.kind == "none"
    assert verdict.search.end is found.base
    assert "no effect passes every test of a claim" in sentences(verdict)


def test_effect_that_no_test_of_the_residuals_shows_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = searched(planted(k_T=0.8))
    passing = replace(found.rounds[0].lack(), windows=(), score=0.0, chi2=0.0)
    monkeypatch.setattr(step_start, "lack_of_fit", lambda *_: passing)
    assert searched(planted(k_T=0.8)).end.effects == ("k_T",)


def test_significant_score_without_enough_gain_is_none_and_says_so() -> None:
    found = searched(planted())
    alarm = replace(found.end_lack, score=found.end_lack.score_critical + 1.0)
    verdict = verdict_on(replace(found, end_lack=alarm))
    assert verdict.kind == "none"
    assert "no effect lowers chi-square enough for a claim" in sentences(verdict)


def test_effects_whose_held_out_runs_do_not_finish_are_said() -> None:
    found = searched(planted(k_T=0.8))
    quiet = replace(found.rounds[0].lack(), windows=(), score=0.0, chi2=0.0)
    verdict = verdict_on(replace(found, end=found.base, end_lack=quiet))
    assert verdict.kind == "none"
    assert verdict.reasons == ("held-out runs do not finish with any effect that gains enough",)


# --- named ----------------------------------------------------------------------------------


@pytest.mark.parametrize("effect", ["k_T", "c_T", "heater_ramp"])
def test_planted_effect_is_named_with_its_strength(effect: str) -> None:
    found = searched(planted(**{effect: 0.8}))
    verdict = verdict_on(found)
    assert verdict.kind == "named", verdict.reasons
    (finding,) = verdict.findings
    assert (finding.leading, finding.effects) == (effect, [effect])
    assert finding.group == known_effects()[effect].group
    assert verdict.confirmed
    assert found.end.strength(effect) == pytest.approx(
        0.8 * strength_of(effect)[1].typical, rel=0.1
    )
    said = sentences(verdict)
    assert f"The model lacks: {finding.group} ({known_effects()[effect].title}" in said
    assert "predictions improve" in said


def test_forms_of_one_group_that_look_alike_are_named_together() -> None:
    columns = alike("heater_ramp", "time_offset")
    verdict = verdict_on(
        searched(planted(heater_ramp=0.8), columns, ("heater_ramp", "time_offset"))
    )
    assert verdict.kind == "named", verdict.reasons
    assert set(verdict.findings[0].effects) == {"heater_ramp", "time_offset"}
    assert verdict.findings[0].group == "timing"
    titles = {known_effects()[name].title for name in ("heater_ramp", "time_offset")}
    assert set(form_words(verdict.findings[0]).split(" or ")) == titles


# --- ambiguous ------------------------------------------------------------------------------


def test_effects_of_two_groups_that_look_alike_are_ambiguous_apparatus_first() -> None:
    verdict = verdict_on(searched(planted(k_T=0.8), alike("k_T", "heater_ramp")))
    assert verdict.kind == "ambiguous", verdict.reasons
    (finding,) = verdict.findings
    assert finding.effects == ["heater_ramp", "k_T"]
    assert finding.group == ""
    said = sentences(verdict)
    assert "slow heater (apparatus) or slope of the conductivity (material)" in said
    assert "Check the apparatus first: it may cause the same misfit." in said
    assert not verdict.confirmed


def test_effect_is_told_from_one_that_looks_less_alike() -> None:
    verdict = verdict_on(searched(planted(k_T=0.8), alike("k_T", "heater_ramp", share=0.6)))
    assert verdict.findings[0].effects == ["k_T"]


def test_rate_at_one_flux_alone_confirms_nothing() -> None:
    found = searched(planted(k_T=1.0), calibrated=MLR_25)
    verdict = verdict_on(found)
    assert found.end.effects == ("k_T",)
    assert verdict.kind == "ambiguous"
    assert "only the mass loss rate at one flux is calibrated" in verdict.reasons
    assert not verdict.confirmed
    assert "but that is not confirmed" in sentences(verdict)


def test_two_effects_from_the_rate_at_one_flux_are_not_confirmed() -> None:
    found = searched(planted(k_T=0.8, heater_ramp=0.8), calibrated=MLR_25)
    verdict = verdict_on(found)
    assert len(verdict.findings) == 2
    assert "only the mass loss rate at one flux is calibrated" in verdict.reasons
    assert verdict.kind == "ambiguous"
    assert not verdict.confirmed
    said = sentences(verdict)
    assert "The model seems to lack 2 effects: " in said
    assert "but that is not confirmed" in said


def test_repeats_at_one_flux_are_one_flux() -> None:
    found = searched(planted(k_T=1.0), calibrated=(0, 2))  # the rates of both experiments
    assert verdict_on(found).kind == "named"
    base = found.base.model.base
    problem = base.likelihood.problem
    runs = dict.fromkeys(problem.runs, next(iter(problem.runs.values())))
    likelihood = replace(base.likelihood, problem=replace(problem, runs=runs))
    model = replace(found.base.model, base=replace(base, likelihood=likelihood))
    rounds = (replace(found.rounds[0], start=replace(found.base, model=model)),)
    assert ONE_FLUX in doubts_of(replace(found, rounds=rounds), ())


# --- multiple -------------------------------------------------------------------------------


def test_two_planted_effects_are_multiple_and_each_is_found() -> None:
    found = searched(planted(k_T=0.8, c_T=-0.7))
    verdict = verdict_on(found)
    assert verdict.kind == "multiple", verdict.reasons
    assert {finding.leading for finding in verdict.findings} == {"k_T", "c_T"}
    assert found.end.strength("c_T") == pytest.approx(-0.7 * strength_of("c_T")[1].typical, rel=0.1)
    assert verdict.confirmed
    assert sentences(verdict).startswith("The model lacks 2 effects: ")


def test_one_of_two_planted_effects_explains_a_part_where_one_is_the_most() -> None:
    verdict = verdict_on(searched(planted(k_T=0.8, c_T=-0.4), most=1))
    assert verdict.kind == "partly"
    assert verdict.confirmed
    (effect,) = (finding.effect for finding in verdict.findings)
    assert {effect, verdict.suspects[0].effect} == {"k_T", "c_T"}
    assert verdict.reasons[0].startswith("part of the misfit remains: slab_")
    signals = verdict.reasons[0].removeprefix("part of the misfit remains: ").split("; ")
    assert all(one.startswith("slab_") and one.endswith(")") for one in signals)
    assert any("(mass loss rate" in one for one in signals)


@pytest.mark.parametrize("p_value", [None, 0.01, 0.2])
def test_effect_is_claimed_beside_misfit_only_where_strengths_agree(
    monkeypatch: pytest.MonkeyPatch, p_value: float | None
) -> None:
    def trusted(*given: Any) -> Trust:
        return replace(real(*given), disagree=p_value)

    real = places.trust
    monkeypatch.setattr(places, "trust", trusted)
    verdict = verdict_on(searched(planted(k_T=0.8, c_T=-0.4), most=1))
    asked = "no strengths can be compared" if p_value is None else "different strengths of "
    told = [reason for reason in verdict.reasons if asked in reason]
    if p_value == 0.2:
        assert verdict.kind == "partly"
        assert told == []
    else:
        assert verdict.kind == "unknown"
        assert not verdict.confirmed
        assert len(told) == 1
        assert "fits best, but does not pass the tests of a claim" in sentences(verdict)


def test_effect_is_claimed_beside_misfit_only_if_no_held_out_laboratory_is_against_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def trusted(trial: FittedModel, *given: Any) -> Trust:
        found = real(trial, *given)
        other = {f"{HELD_OUT}: A": -30.0, f"{HELD_OUT}: B": 30.0, f"{HELD_OUT}: C": 30.0}
        return replace(found, gains=found.gains | other)

    real = places.trust
    monkeypatch.setattr(places, "trust", trusted)
    verdict = verdict_on(searched(planted(k_T=0.8, c_T=-0.4), most=1))
    assert verdict.kind == "unknown"
    assert any("the prediction of A gets worse with " in reason for reason in verdict.reasons)


def test_effect_is_claimed_beside_misfit_only_if_no_other_term_fits_as_well(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    other = OtherTerm("a conductivity that varies with temperature", above=3.0, most=20.0)
    monkeypatch.setattr(
        judging, "other_terms", lambda end, without, *given: [[other] for _ in without]
    )
    verdict = verdict_on(searched(planted(k_T=0.8, c_T=-0.4), most=1))
    assert verdict.kind == "unknown"
    assert any(f"may be replaced by {other.words}" in reason for reason in verdict.reasons)


def test_alternatives_of_one_of_two_effects_keep_the_other() -> None:
    found = searched(planted(k_T=0.8, c_T=-0.7), alike("k_T", "heater_ramp"))
    names = dict(alternatives(found, "k_T"))
    assert list(names) == ["k_T", "heater_ramp"] or list(names) == ["heater_ramp", "k_T"]
    assert all("c_T" in trial.effects for trial in names.values())
    assert list(dict(alternatives(found, "c_T"))) == ["c_T"]


def test_effect_that_another_makes_superfluous_is_dropped() -> None:
    found = searched(planted(k_T=0.8))
    both = fit_with(found.base, "c_T", "k_T")
    verdict = verdict_on(replace(found, end=both))
    assert verdict.kind == "named", verdict.reasons
    assert verdict.search.end.effects == ("k_T",)
    rows = candidate_records(verdict.search, verdict, final_fits(verdict, None))
    (row,) = [row for row in rows if row.free == {"k_T": ["slope_1_K"]}]
    assert row.rejected == ""


def test_no_pass_ends_above_a_model_that_an_earlier_one_found() -> None:
    base = searched(planted(k_T=0.8, c_T=-0.7)).base
    earlier = fit_with(base, "c_T", "k_T")
    context = SearchContext(np.random.default_rng(1))
    first = look_first(base, ("heater_ramp",), context)
    found = Pass(("heater_ramp",), 3, context, (earlier,)).run(first)
    assert set(found.end.effects) == {"c_T", "k_T"}
    assert found.end.fit.chi2 <= earlier.fit.chi2
    alone = Pass(("heater_ramp",), 3, context).run(first)
    assert set(alone.end.effects) <= {"heater_ramp"}


def test_model_without_an_effect_is_the_best_one_at_hand() -> None:
    """A descent from where the effects end may miss a valley that was found before."""
    found = searched(planted(k_T=0.8, c_T=-0.7))
    assert len(found.end.effects) == 2
    lower = [
        moved(trial, chi2=trial.fit.chi2 - 40.0) if trial.effects == ("k_T",) else trial
        for trial in found.rounds[0].trials
    ]
    rounds = (replace(found.rounds[0], trials=tuple(lower)), *found.rounds[1:])
    at = found.end.effects.index("c_T")
    before, after = (
        without_each(searched, 1)[at].fit.chi2
        for searched in (found, replace(found, rounds=rounds))
    )
    assert after == pytest.approx(before - 40.0, abs=0.1)


# --- one effect or two ----------------------------------------------------------------------

SLOPES = ("c_T", "glass_transition", "k_T")


def like_two(share: float) -> dict[str, FloatArray]:
    """Return columns in which a glass transition with fitted forms looks like two slopes.

    The bend adds a slope of the conductivity. A share of the heater's column differs from a slope
    of the heat capacity; the width takes it back.
    """
    forms = known_effects()["glass_transition"].quantities
    step, bend = forms["step_J_kgK"].typical, forms["bend_kg_J"].typical
    of_c, of_k, apart = (
        column_of(COLUMNS, name) * strength_of(name)[1].typical
        for name in ("c_T", "k_T", "heater_ramp")
    )
    return {
        **COLUMNS,
        linear.strength_name("glass_transition"): (of_c + share * apart) / step,
        name_of("glass_transition", "bend_kg_J"): of_k / bend,
        name_of("glass_transition", "width_K"): -0.7 * share * apart / 20.0,
    }


def test_two_effects_are_found_where_one_with_free_forms_leaves_only_noise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    y, columns = planted(k_T=0.8, c_T=0.7), like_two(0.5)
    with monkeypatch.context() as patched:
        patched.setattr(Pass, "_split", lambda self, found: found)
        before = searched(y, columns, SLOPES)
    assert before.end.effects == ("glass_transition",)
    assert before.end.numbers == 3
    assert before.end_lack.adequate
    found = searched(y, columns, SLOPES)
    assert set(found.end.effects) == {"c_T", "k_T"}
    assert any(trial.fit.chi2 == before.end.fit.chi2 for trial in found.trials)
    assert verdict_on(found).kind == "multiple"
    alone = searched(y, columns, SLOPES, most=1)
    assert alone.end.effects == ("glass_transition",), "no more effects than allowed"


def test_effect_that_two_others_replace_as_well_is_not_certain() -> None:
    found = searched(planted(k_T=0.8, c_T=0.7), like_two(0.0), SLOPES)
    assert found.end.effects == ("glass_transition",)
    verdict = verdict_on(found)
    assert verdict.kind == "ambiguous", verdict.reasons
    assert not verdict.confirmed
    (said,) = verdict.reasons
    slopes = {"slope of the specific heat", "slope of the conductivity"}
    start, end = "glass transition may be replaced by ", ", with nearly as good a fit"
    assert said.startswith(start)
    assert said.endswith(end)
    assert set(said[len(start) : -len(end)].split(" together with ")) == slopes
    tried = {frozenset(trial.effects) for trial in undecided_models(verdict.search, verdict)}
    assert tried == {frozenset({"glass_transition"}), frozenset({"c_T", "k_T"})}


def test_two_effects_that_one_replaces_as_well_are_not_certain() -> None:
    found = searched(planted(k_T=0.8, c_T=0.7), like_two(0.0), SLOPES)
    (pair, *_) = (t for t in found.trials if set(t.effects) == {"c_T", "k_T"})
    verdict = verdict_on(replace(found, end=pair))
    assert verdict.kind == "multiple", verdict.reasons
    assert not verdict.confirmed
    assert " may be replaced by glass transition, with nearly as good a fit" in verdict.reasons[0]


def test_superfluous_second_effect_is_no_exchange() -> None:
    """One that fits as well alone is an alternative, with any other effect beside it."""
    found = searched(planted(k_T=0.8), alike("k_T", "heater_ramp"))
    assert found.end.effects == ("k_T",)
    both = fit_with(found.base, "heater_ramp", "c_T")
    assert both.penalised <= found.end.penalised + Settings().ambiguous_chi2
    step = replace(found.rounds[0], trials=(*found.rounds[0].trials, both))
    assert exchanges(replace(found, rounds=(step,)), "k_T") == []
    alone = [t for t in step.trials if "heater_ramp" not in t.effects or t is both]
    without = replace(found, rounds=(replace(step, trials=tuple(alone)),))
    (one,) = exchanges(without, "k_T")
    assert one.by == ("heater_ramp", "c_T")


# --- unknown --------------------------------------------------------------------------------


ELSEWHERE = {
    name: column * (np.arange(TOTAL) >= (2 * POINTS if name.endswith(("K", "s")) else 0))
    for name, column in COLUMNS.items()
}
"""Columns of which no effect shows at the first flux."""


def test_misfit_that_no_effect_explains_is_unknown() -> None:
    y = planted()
    y[20:26] += 7.0
    found = searched(y, ELSEWHERE)
    verdict = verdict_on(found)
    assert verdict.kind == "unknown"
    assert verdict.findings == ()
    assert "no effect of the catalogue explains it" in sentences(verdict)
    assert [(w.channel, w.sign) for w in found.end_lack.windows] == [(0, -1)]
    assert abs(found.end_lack.windows[0].start - 20) <= 1


def test_effect_of_one_experiment_is_not_claimed_beside_misfit() -> None:
    y = planted() + 0.8 * strength_of("k_T")[1].typical * column_of(ELSEWHERE, "k_T")
    y[20:26] += 9.0
    verdict = verdict_on(searched(y, ELSEWHERE))
    assert verdict.kind == "unknown"
    assert [finding.leading for finding in verdict.findings] == ["k_T"]
    assert any("no strengths can be compared" in reason for reason in verdict.reasons)


@pytest.mark.parametrize(
    ("left", "kind", "told"),
    [
        (9.0, "partly", "explains only a part of the misfit"),
        (14.0, "unknown", "the mass loss rate of slab_25 is missed by 4"),
    ],
)
def test_effect_of_both_experiments_explains_a_part_where_little_misfit_is_left(
    left: float, kind: str, told: str
) -> None:
    y = planted(k_T=0.8)
    y[20:26] += left
    verdict = verdict_on(searched(y))
    assert verdict.kind == kind
    assert [finding.leading for finding in verdict.findings] == ["k_T"]
    assert told in sentences(verdict)


def test_effect_behind_a_rejected_one_is_not_claimed_where_misfit_is_left(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It may take the place of the rejected one only if nothing but noise is left."""

    def against(gain: float, spare: float, about: Trust) -> str:
        return "rejected" if about.limit == "k_T" else ""

    def trusted(trial: FittedModel, effect: str, *given: Any) -> Trust:
        return replace(real(trial, effect, *given), limit=effect)

    real = places.trust
    monkeypatch.setattr(places, "trust", trusted)
    monkeypatch.setattr(places, "words_against", against)
    monkeypatch.setattr(places, "strengths_at_limit", lambda trial: list(trial.effects))
    unknown = np.tile(np.repeat([1.5, -1.5], POINTS // 2), 4)
    columns = alike("k_T", "c_T", share=0.001)
    found = searched(planted(k_T=1.0) + unknown, columns, ("c_T", "k_T"), most=1)
    assert not found.end_lack.adequate
    verdict = verdict_on(found)
    (finding,) = verdict.findings
    assert [(j.effect, bool(j.rejected)) for j in finding.judged] == [("k_T", True), ("c_T", False)]
    assert verdict.kind == "unknown"


def test_unknown_beside_misfit_tells_the_test_that_the_leading_effect_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    real = places.trust
    gains = {"25 kW/m²": 5.0, "held out: one": 3.0, "held out: other": -2.1}
    monkeypatch.setattr(
        places,
        "trust",
        lambda *of: replace(real(*of), gains=gains, powers=dict.fromkeys(gains, 3.0)),
    )
    unknown = np.tile(np.repeat([1.5, -1.5], POINTS // 2), 4)
    found = searched(planted(k_T=1.0) + unknown, effects=("k_T",), most=1)
    assert not found.end_lack.adequate
    verdict = verdict_on(found)
    assert verdict.kind == "unknown"
    assert "signals gains +0.9 only; a confirmation needs 2" in verdict.reasons[0]
    assert verdict.reasons[1].startswith("the residuals exceed the noise")


def test_effects_that_leave_only_noise_are_unknown_where_one_of_them_fails() -> None:
    """Taken away, it would leave a misfit that the other explains in part."""
    q = strength_of("c_T")[1]
    beyond = 1.005 * (q.lower if q.typical < 0.0 else q.upper) / q.typical
    found = searched(planted(k_T=0.8, c_T=beyond))
    assert set(found.end.effects) == {"k_T", "c_T"}
    assert found.end_lack.adequate
    verdict = verdict_on(found)
    assert verdict.kind == "unknown"
    assert not verdict.confirmed
    assert "slope of the specific heat: c_T_slope_1_K is at a limit" in verdict.reasons


def test_effect_at_its_limit_is_not_claimed() -> None:
    q = strength_of("k_T")[1]
    beyond = 1.3 * (q.lower if q.typical < 0.0 else q.upper) / q.typical
    verdict = verdict_on(searched(planted(k_T=beyond)))
    assert verdict.kind == "unknown"
    assert "slope of the conductivity: k_T_slope_1_K is at a limit" in verdict.reasons
    assert "fits best, but does not pass the tests of a claim." in sentences(verdict)


def test_effect_whose_strength_differs_between_experiments_is_not_claimed() -> None:
    later = np.arange(TOTAL) >= 2 * POINTS
    y = planted(k_T=0.3)
    y = y + 0.8 * strength_of("k_T")[1].typical * column_of(COLUMNS, "k_T") * later
    verdict = verdict_on(searched(y, effects=("k_T",)))
    assert verdict.kind == "unknown"
    assert any("ask for different strengths (p = " in reason for reason in verdict.reasons)


def test_effect_that_makes_predictions_worse_is_rejected_with_their_scores() -> None:
    found = searched(planted(k_T=0.8))
    finding = verdict_on(found).findings[0]
    judged = finding.judged[0]
    worse = replace(judged.trust, gains={"slab_25": 30.0, "slab_60": -4.0})
    assert words_against(100.0, found.spare, judged.trust) == ""
    said = words_against(100.0, found.spare, worse)
    assert "log score -4.0 for slab_60, +26.0 in all" in said
    unfinished = replace(worse, powers={"slab_60": float("inf")})
    assert "a run of slab_60 does not finish" in words_against(100.0, found.spare, unfinished)
    none_left = replace(finding, judged=(Judged("k_T", judged.trial, worse, said),))
    assert (none_left.kept, none_left.effects, none_left.predicted) == ([], [], False)
    assert none_left.leading == "k_T"


def test_claim_that_predicts_what_is_held_out_no_better_is_open_and_says_so() -> None:
    finding = verdict_on(searched(planted(k_T=0.8))).findings[0]
    found = searched(planted(k_T=0.8))
    judged = finding.judged[0]
    assert finding.predicted
    little = replace(judged, trust=replace(judged.trust, gains={"slab_25": 30.0, HELD_OUT: 1.9}))
    unsure = replace(finding, judged=(little,))
    assert unsure.kept == [little]
    assert not unsure.predicted
    assert not unsure.sure
    (said,) = doubts_of(found, [unsure])
    assert said.startswith(
        "with slope of the conductivity, the log score of held-out signals gains"
    )
    assert "gains +1.9 only" in said


def test_verdict_on_two_effects_is_the_same_by_two_processes() -> None:
    found = searched(planted(k_T=0.8, c_T=-0.7))
    one, two = (judge(found, np.random.default_rng(2), processes) for processes in (1, 2))
    assert [f.effects for f in one.findings] == [f.effects for f in two.findings]
    assert [j.trust for f in one.findings for j in f.judged] == [
        j.trust for f in two.findings for j in f.judged
    ]


def test_claim_that_does_not_explain_what_is_held_out_is_open() -> None:
    y = planted(k_T=0.8)
    y[3 * POINTS + 20 : 3 * POINTS + 30] += 8.0
    verdict = verdict_on(searched(y, calibrated=(0, 1, 2)))
    assert verdict.kind == "ambiguous"
    assert any("does not explain held-out signals" in reason for reason in verdict.reasons)


def test_next_experiment_tells_apart_the_two_best_models_of_different_effects() -> None:
    y = planted(k_T=0.8, c_T=-0.7)
    y[20:26] += 12.0
    found = searched(y, ELSEWHERE, EFFECTS)
    verdict = verdict_on(found)
    assert verdict.kind == "unknown"
    one, other = undecided_models(verdict.search, verdict)
    assert set(one.effects) != set(other.effects)
    assert one.penalised == min(trial.penalised for trial in found.trials)
    between = [t for t in found.trials if one.penalised < t.penalised < other.penalised]
    assert all(set(trial.effects) == set(one.effects) for trial in between)


def test_next_experiment_tells_apart_all_that_is_left_open() -> None:
    verdict = verdict_on(searched(planted(k_T=0.8), alike("k_T", "heater_ramp")))
    left = undecided_models(verdict.search, verdict)
    assert {trial.effects for trial in left} == {("heater_ramp",), ("k_T",)}


# --- search and record ----------------------------------------------------------------------


def test_no_fit_with_an_effect_ends_above_the_one_without() -> None:
    for y in (planted(k_T=0.8), planted(k_T=0.8, c_T=-0.7)):
        found = searched(y, effects=EFFECTS)
        assert len(found.trials) >= len(EFFECTS)
        for step in found.rounds:
            # A column more, of strength zero, rounds the products of this model otherwise.
            most = step.start.fit.chi2 * (1.0 + 1e-14)
            assert all(trial.fit.chi2 <= most for trial in step.trials)


def test_claims_gain_as_much_as_is_asked_for() -> None:
    found = searched(planted(k_T=0.8, c_T=-0.7))
    rows = listed(found)
    assert found.spare == pytest.approx(2.0 * np.log(3.0))
    best = min(rows, key=lambda row: row.penalised)
    assert set(best.effects) == {"k_T", "c_T"}
    assert best.penalised == pytest.approx(best.chi2 + 2.0 * np.log(TOTAL))
    assert best.gain > found.spare + np.log(TOTAL)


def test_every_candidate_that_is_not_claimed_says_why() -> None:
    found = searched(planted(k_T=0.8), effects=EFFECTS)
    rows = listed(found)
    reasons = {tuple(row.effects): row.rejected for row in rows}
    assert reasons.pop(("k_T",)) == ""
    assert reasons
    assert all(reasons.values()), reasons


def test_every_model_is_listed_once() -> None:
    found = searched(planted(k_T=0.8, c_T=-0.7), effects=EFFECTS)
    rows = listed(found)
    models = [sorted((e, *p) for e, p in row.free.items()) for row in rows]
    assert len(rows) > 10
    assert [m for i, m in enumerate(models) if m in models[:i]] == []
