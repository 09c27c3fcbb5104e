"""A step of the search: which fits are rough only, and which predictions are made again."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import linear
import numpy as np
import pytest
from linear import TOTAL, column_of, fit_with

from pyrofit.diagnose.base import prediction
from pyrofit.diagnose.base.adequacy import LackOfFit
from pyrofit.diagnose.base.fitted import FittedModel, up_to_date
from pyrofit.diagnose.base.model import extended, strength_of
from pyrofit.diagnose.base.prediction import Made, model_predictions
from pyrofit.diagnose.judge import places, verdict
from pyrofit.diagnose.judge.inflation import inflation_by_misfit
from pyrofit.diagnose.judge.places import end_without_superfluous
from pyrofit.diagnose.result import candidates
from pyrofit.diagnose.search import step, stepwise
from pyrofit.diagnose.search.refit import model_with
from pyrofit.diagnose.search.score_test import Screening
from pyrofit.diagnose.search.step import SearchContext, more, most_promising, promising_or_kin
from pyrofit.diagnose.search.step_start import step_from as look_first
from pyrofit.diagnose.search.stepwise import Search, search_effects, settled
from pyrofit.diagnose.settings import Settings
from pyrofit.solver.arrays import FloatArray

EFFECTS = ("c_T", "heater_ramp", "k_T")
COLUMNS = linear.random_columns(6, *EFFECTS, "back_loss", size=60.0)
CONTEXT = SearchContext(np.random.default_rng(1))


def planted(*effects: str) -> FloatArray:
    y = np.random.default_rng(1).standard_normal(TOTAL)
    y = y + 2.0 * COLUMNS["rho"] - COLUMNS["k"]
    for effect in effects:
        quantity = strength_of(effect)[1]
        y = y + quantity.typical * column_of(COLUMNS, effect)
    return np.asarray(y)


@pytest.fixture(scope="module")
def base() -> FittedModel:
    return linear.fit(COLUMNS, planted("k_T"))


@dataclass
class Refined:
    """Effects of the fits that a step works on: followed to the end, polished, and from where."""

    followed: list[str] = field(default_factory=list)
    polished: list[str] = field(default_factory=list)
    starts: list[tuple[float | None, Sequence[int]]] = field(default_factory=list)
    """Tolerance and other starts of each fit from elsewhere."""


@pytest.fixture
def refined(monkeypatch: pytest.MonkeyPatch) -> Refined:
    """Note what would be refined, and leave each fit as it is."""
    noted = Refined()

    def followed(trial: FittedModel) -> FittedModel:
        noted.followed.append(trial.effects[-1])
        return trial

    def polished(trials: Sequence[FittedModel], processes: int) -> list[FittedModel]:
        noted.polished.extend(trial.effects[-1] for trial in trials)
        return list(trials)

    def from_elsewhere(
        trial: FittedModel,
        seen: Screening,
        end: FittedModel,
        others: Sequence[int],
        enough: float | None = None,
    ) -> FittedModel:
        noted.starts.append((enough, others))
        return end

    monkeypatch.setattr(step, "followed", followed)
    monkeypatch.setattr(step, "polished", polished)
    monkeypatch.setattr(step, "from_elsewhere", from_elsewhere)
    monkeypatch.setattr(step, "starts", lambda seen: [0, 1, 2])
    return noted


def step_from(
    base: FittedModel, monkeypatch: pytest.MonkeyPatch, effect: str, share: float, chi2: float
) -> None:
    """Try an effect whose first fit ends at this share of the typical strength."""
    quantity = strength_of(effect)[1]
    value = quantity.value + share * (quantity.typical - quantity.value)

    def rough(trial: FittedModel, seen: Screening, enough: float) -> FittedModel:
        fit = replace(trial.fit, x=extended(trial.fit.x, seen.effect, value), chi2=chi2)
        return FittedModel(model_with(trial, seen.effect), fit)

    monkeypatch.setattr(step, "from_best_start", rough)
    more([(look_first(base, [effect], CONTEXT), 1)], CONTEXT)


@pytest.mark.parametrize(("above", "closer"), [(0.9, True), (1.1, False)])
def test_fits_far_above_a_model_at_hand_stay_rough(
    base: FittedModel, refined: Refined, above: float, closer: bool
) -> None:
    """One that ends more than `hopeless_chi2` above it is neither refined nor polished."""
    best = fit_with(base, "k_T").penalised - above * Settings().hopeless_chi2
    (trials,) = more([(look_first(base, EFFECTS, CONTEXT), 3)], CONTEXT, best)
    assert {trial.effects[-1] for trial in trials} == set(EFFECTS), "rough fits are kept"
    assert ("k_T" in refined.followed, "k_T" in refined.polished) == (closer, closer)


@pytest.mark.parametrize(("share", "closer"), [(0.9, False), (1.1, True)])
def test_fits_that_gain_next_to_nothing_stay_rough(
    base: FittedModel,
    refined: Refined,
    monkeypatch: pytest.MonkeyPatch,
    share: float,
    closer: bool,
) -> None:
    step_from(base, monkeypatch, "k_T", 1.0, base.fit.chi2 - share * Settings().hopeless_gain)
    assert (bool(refined.followed), bool(refined.polished)) == (closer, closer)


@pytest.mark.parametrize(
    ("effect", "share", "again"),
    [("k_T", 0.2, True), ("k_T", -0.2, True), ("k_T", 0.5, False), ("back_loss", 0.2, True)],
)
def test_effect_that_ends_near_its_null_value_is_fitted_from_a_second_start(
    base: FittedModel,
    refined: Refined,
    monkeypatch: pytest.MonkeyPatch,
    effect: str,
    share: float,
    again: bool,
) -> None:
    """Even where it gains much. The start that was tried then is not tried again."""
    step_from(base, monkeypatch, effect, share, 0.5 * base.fit.chi2)
    rough = Settings().rough_gain
    wanted = [(rough, [1]), (None, [2])] if again else [(None, [1, 2])]
    assert refined.starts == wanted


def test_all_effects_of_a_group_are_tried_in_the_place_of_one(base: FittedModel) -> None:
    effects = ("c_T", "heater_ramp", "k_T", "time_offset")
    columns = linear.random_columns(9, *effects, size=60.0)
    looks = look_first(linear.fit(columns, planted("k_T")), effects, CONTEXT)
    first = [look.effect for look in most_promising(looks, 4)]
    assert first[-1] in ("heater_ramp", "time_offset"), "one of a group promises least"
    kin = {"heater_ramp": "time_offset", "time_offset": "heater_ramp"}
    for effect in ("k_T", *kin):
        wanted = [e for k, e in enumerate(first) if k < 3 or e == kin.get(effect) or e == effect]
        assert [look.effect for look in promising_or_kin(looks, effect)] == wanted


def test_exchange_fits_all_that_are_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[tuple[Any, int]] = []

    def noted(tried: Any, context: Any, best: float) -> list[tuple[()]]:
        given.extend(tried)
        return [() for _ in tried]

    monkeypatch.setattr(stepwise, "more", noted)
    monkeypatch.setattr(stepwise, "promising_or_kin", lambda step, effect: list(step.looks))
    others = ("back_loss", "heater_ramp")
    settings = replace(Settings(), most_exchanged=1)
    base = linear.fit(COLUMNS, planted("k_T"), settings=settings)
    end = fit_with(base, "c_T", "k_T")
    lack = LackOfFit((), 0.0, 1.0, 0.0, 1.0, 0.0, 1.0)
    found = Search((look_first(base, [], CONTEXT),), end, lack, 0.0)
    stepwise.Pass(("c_T", "k_T", *others), 3, CONTEXT)._exchanged(found)
    assert [len(step.looks) for step, _ in given] == [len(others)] * 2
    assert all(most >= len(others) for _, most in given)


def test_search_is_steered_by_the_settings_of_its_base() -> None:
    """One that tries no second effect ends with one, and looks at the stated strengths alone."""
    none = {"candidates_of_first_branch": 0, "candidates_of_second_branch": 0}
    settings = replace(Settings(), tried_strengths=(0.5,), **none)
    for given, count in ((Settings(), 2), (settings, 1)):
        start = linear.fit(COLUMNS, planted("c_T", "k_T"), settings=given)
        found = search_effects(start, ("c_T", "k_T"), 3, CONTEXT)
        assert len(found.end.effects) == count
    (first, *_) = found.rounds
    for look in first.looks:
        half = 0.5 * abs(strength_of(look.effect)[1].typical)
        assert look.strengths == pytest.approx([half, -half])


def test_predictions_begin_with_the_derivatives_at_hand(
    base: FittedModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of the channels that remain; the scores are those of a start without derivatives."""
    trial, begun = fit_with(base, "k_T"), []

    def descend(model: Any, x: FloatArray, begin: FloatArray | None) -> Any:
        begun.append(None if begin is None else begin - model.jacobian(x, model.residuals(x)))
        return real(model, x, None)

    real = prediction.descend_chi_square
    (own,) = model_predictions([trial])
    monkeypatch.setattr(prediction, "descend_chi_square", descend)
    (anew,) = model_predictions([trial])
    assert len(begun) == 2
    assert all(wrong is not None and float(np.abs(wrong).max()) < 1e-6 for wrong in begun)
    assert own.scores == pytest.approx(anew.scores, abs=Settings().converged_gain)


def test_predictions_made_before_are_not_made_again(
    base: FittedModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are known by the fit that they start from, whatever model holds it."""
    made: Made = {}
    trial = fit_with(base, "k_T")
    (first,) = model_predictions([trial], made=made)
    monkeypatch.setattr(prediction, "_refit", None)
    same, again = model_predictions([trial, up_to_date(trial)], made=made)
    assert first.scores == same.scores == again.scores
    with pytest.raises(TypeError):
        model_predictions([base], made=made)


def two_effects_and_a_misfit(c_T_share: float) -> Search:
    """Return a search that ends with k_T and c_T, on whose strength the experiments disagree."""
    strengths = np.where(np.arange(TOTAL) < TOTAL // 2, 1.0 - c_T_share, 1.0)
    size = 2.0 * strength_of("c_T")[1].typical
    y = planted("k_T") + strengths * size * column_of(COLUMNS, "c_T")
    start = linear.fit(COLUMNS, y)
    context = SearchContext(np.random.default_rng(1))
    return search_effects(start, ("c_T", "k_T"), 2, context)


@pytest.mark.parametrize(("share", "needed_judgements"), [(0.4, 2), (1.5, 1)])
def test_effects_are_judged_until_one_fails_the_one_that_gains_least_first(
    monkeypatch: pytest.MonkeyPatch, share: float, needed_judgements: int
) -> None:
    """The predictions of the others are then not needed."""
    judged: list[int] = []

    def findings_of(
        found: Search, without: Any, context: Any, which: list[int], leading_first: bool
    ) -> Any:
        judged.extend(which)
        findings = places.findings_of(found, without, context, which, leading_first)
        whole = places.findings_of(found, without, context, which)
        leading, whole_leading = findings[0].judged[0], whole[0].judged[0]
        assert leading.rejected == whole_leading.rejected
        # Others are not judged beside a leading effect that is rejected.
        assert len(findings[0].judged) == (1 if leading.rejected else len(whole[0].judged))
        return findings

    monkeypatch.setattr(verdict, "findings_of", findings_of)
    monkeypatch.setattr(verdict, "still_missed", lambda finding: [])  # both leave much
    context = SearchContext(np.random.default_rng(2))
    found, without = end_without_superfluous(two_effects_and_a_misfit(share), context)
    assert set(found.end.effects) == {"c_T", "k_T"}
    _, failed = verdict._judged_beside_misfit(found, without, context)
    penalised = inflation_by_misfit(found).penalised
    order = sorted((0, 1), key=lambda k: penalised(without[k]))
    findings = places.findings_of(found, without, context)
    against = [verdict._against(finding, beside_misfit=True) for finding in findings]
    unsupported = [k for k in order if against[k]]
    assert failed == (unsupported[0], against[unsupported[0]])
    assert judged == order[:needed_judgements]
    assert len(unsupported) == 1, "the other effect passes"


@pytest.mark.parametrize(
    ("excess", "misfit", "effects", "most", "ends"),
    [
        (1.0, 1.0, ("k_T",), 6, True),  # The residuals are noise.
        (1.0, 3.0, ("k_T",), 6, True),  # A misfit beside noise of the stated size.
        (3.8, 3.0, ("k_T",), 6, False),  # A misfit where a signal scatters more than stated.
        (3.8, 1.0, ("k_T",), 6, False),
        (3.8, 3.0, ("k_T",), 1, True),  # No effect more is allowed.
        (3.8, 3.0, (), 6, True),
    ],
)
def test_search_is_repeated_where_a_larger_noise_than_stated_may_hide_misfit(
    base: FittedModel,
    excess: float,
    misfit: float,
    effects: tuple[str, ...],
    most: int,
    ends: bool,
) -> None:
    end = fit_with(base, *effects)
    likelihood = end.model.base.likelihood
    noise = (replace(likelihood.noise[0], excess=excess), *likelihood.noise[1:])
    wider = replace(end.model.base, likelihood=replace(likelihood, noise=noise))
    residuals = end.fit.residuals.copy()
    residuals[linear.POINTS : 2 * linear.POINTS] *= misfit
    end = FittedModel(replace(end.model, base=wider), replace(end.fit, residuals=residuals))
    lack = LackOfFit((), 0.0, 1.0, 0.0, 1.0, misfit, 2.0)
    assert settled(Search((), end, lack, 0.0), most) == ends


@pytest.mark.parametrize(
    ("bad", "end"), [(("k_T",), ("c_T",)), (("k_T", "c_T"), ())], ids=["one", "all"]
)
def test_model_whose_held_out_runs_do_not_finish_is_left_out(
    monkeypatch: pytest.MonkeyPatch, bad: tuple[str, ...], end: tuple[str, ...]
) -> None:
    """The best of the others ends the search, the base at last."""
    columns = linear.random_columns(6, "c_T", "k_T", size=60.0)
    y = planted("k_T") + strength_of("c_T")[1].typical * column_of(columns, "c_T") / 3.0
    start = linear.fit(columns, y)
    for module in (stepwise, candidates):
        monkeypatch.setattr(module, "finishes", lambda trial: not set(trial.effects) & set(bad))
    told: list[str] = []
    context = SearchContext(np.random.default_rng(1), tell=told.append)
    found = search_effects(start, ["c_T", "k_T"], 6, context)
    assert found.end.effects == end
    best = min(found.trials, key=lambda trial: trial.penalised)
    why = candidates._why_not(found, found.base, best, found.end.penalised)
    assert why == "the simulation of a held-out test fails"
    assert any("held-out runs do not finish" in text for text in told)
