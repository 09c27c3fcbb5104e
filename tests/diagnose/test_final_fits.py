"""The fits of a verdict: runs as fine as the study asks for, and intervals over several models."""

from dataclasses import replace

import linear
import numpy as np
import pytest
from linear import TOTAL, column_of, fit_with
from small import base_of, clean, measured, study, truth_of

from pyrofit.diagnose.base import accuracy
from pyrofit.diagnose.base.accuracy import with_accuracy
from pyrofit.diagnose.base.descent import descend_chi_square, refreshed
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import model_of, name_of, strength_of
from pyrofit.diagnose.diagnosis import examine
from pyrofit.diagnose.judge.final_fits import final_fits
from pyrofit.diagnose.judge.findings import Exchange
from pyrofit.diagnose.judge.intervals import (
    interval_over_models,
    strengths,
    values_of,
    wide_intervals,
    with_all_forms,
)
from pyrofit.diagnose.judge.verdict import judge
from pyrofit.diagnose.result.candidates import candidate_records
from pyrofit.diagnose.search.step import SearchContext
from pyrofit.diagnose.search.stepwise import Search, search_effects
from pyrofit.diagnose.settings import Settings
from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.arrays import FloatArray

EFFECTS = ("c_T", "heater_ramp", "k_T")
COLUMNS = linear.random_columns(6, *EFFECTS, size=60.0)


def coarse_fit() -> tuple[FittedModel, Accuracy]:
    """Return the base fitted with coarse runs to curves of fine ones, and the fine accuracy."""
    fine = base_of(study(), clean({}))
    problem = fine.likelihood.problem
    coarse = replace(problem, accuracy=problem.accuracy.coarsened())
    model = model_of(replace(fine, likelihood=replace(fine.likelihood, problem=coarse)), {})
    fit = refreshed(model, descend_chi_square(model, truth_of(fine, {})))
    return FittedModel(model, fit), problem.accuracy


def test_finer_runs_take_back_the_shift_of_coarse_ones() -> None:
    trial, of_study = coarse_fit()
    (found,) = with_accuracy(trial, [trial], of_study)
    truth = truth_of(trial.model.base, {})
    sd = np.sqrt(np.diag(trial.posterior.covariance()))
    assert np.abs((trial.fit.x - truth) / sd).max() > 0.3
    assert np.abs((found.fit.x - truth) / sd).max() < 0.02
    assert found.fit.fresh


def test_work_of_finer_runs_is_bounded() -> None:
    trial, of_study = coarse_fit()
    (found,) = with_accuracy(trial, [trial], of_study)
    of = found.model.likelihood.problem.accuracy
    assert of.tolerance == of_study.tolerance
    assert of.most_steps < of_study.most_steps


def test_trial_whose_fine_run_does_not_finish_stays() -> None:
    trial, of_study = coarse_fit()
    few = of_study.model_copy(update={"most_steps": 5, "first_step_s": 1e-6})
    assert with_accuracy(trial, [trial], few) == [trial]


def test_trial_whose_held_out_run_does_not_finish_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    trial, of_study = coarse_fit()
    monkeypatch.setattr(accuracy, "finishes", lambda fit: False)
    assert with_accuracy(trial, [trial], of_study) == [trial]


def looks_like(effect: str, other: str) -> dict[str, FloatArray]:
    """Return columns of an effect and of another one that adds a share of a third."""
    nearly = 0.95 * column_of(COLUMNS, effect) + 0.3 * column_of(COLUMNS, "c_T")
    ratio = strength_of(effect)[1].typical / strength_of(other)[1].typical
    return {**COLUMNS, linear.strength_name(other): nearly * ratio}


def two_effects() -> Search:
    """Return a search whose final model has two effects, one of which another replaces as well."""
    rng = np.random.default_rng(1)
    y = rng.standard_normal(TOTAL)
    for effect in ("k_T", "c_T"):
        y = y + 0.8 * strength_of(effect)[1].typical * column_of(COLUMNS, effect)
    columns = looks_like("k_T", "heater_ramp")
    base = linear.fit(columns, y)
    return search_effects(
        base, EFFECTS, 3, SearchContext(np.random.default_rng(1), lambda text: None)
    )


def test_wide_interval_spans_the_models_that_are_not_separated() -> None:
    found = two_effects()
    verdict = judge(found, np.random.default_rng(2))
    final = final_fits(verdict, None)
    assert len(final.leading) == 2
    rows = [row for row in candidate_records(found, verdict, final) if not row.rejected]
    assert {tuple(sorted(row.effects)) for row in rows} == {
        ("c_T", "k_T"),
        ("c_T", "heater_ramp"),
    }
    name = linear.strength_name("c_T")
    own = [row.parameters[name] for row in rows]
    lows, highs = ([getattr(p, key) for p in own] for key in ("low", "high"))
    assert max(lows) - min(lows) > 0.1 * (highs[0] - lows[0]), "the models disagree"
    for p in own:
        assert (p.low_wide, p.high_wide) == (min(lows), max(highs))


def test_interval_of_a_single_model_is_stated_once() -> None:
    trial = fit_with(two_effects().base, "k_T")
    (found,) = strengths(trial, wide_intervals([trial])).values()
    assert found.low_wide is None
    assert found.high_wide is None
    other = {linear.strength_name("k_T"): (-1.0, 1.0)}
    (found,) = strengths(trial, other).values()
    assert (found.low_wide, found.high_wide) == (-1.0, 1.0)


def test_final_fits_hold_base_and_end_and_leave_other_trials() -> None:
    found = two_effects()
    final = final_fits(judge(found, np.random.default_rng(2)), None)
    assert {found.base.key, found.end.key} <= set(final.fits)
    other = fit_with(found.base, "heater_ramp")
    assert final.of(other) is other


def test_models_with_all_forms_are_those_of_their_effects() -> None:
    columns = {**COLUMNS, **linear.random_columns(7, "glass_transition", size=60.0)}
    for form in ("bend_kg_J", "width_K", "temperature_K"):
        wave = np.sin(np.linspace(0.0, 7.0 + len(form), TOTAL))
        columns[name_of("glass_transition", form)] = wave * 1e-2
    base = linear.fit(columns, np.random.default_rng(1).standard_normal(TOTAL))
    plain, formed = fit_with(base, "k_T"), fit_with(base, "glass_transition")
    without, with_forms = with_all_forms([plain, formed])
    assert without == {}
    (model,) = with_forms.values()
    assert len(model.model.effects["glass_transition"]) > len(
        formed.model.effects["glass_transition"]
    )
    values, sd = values_of(model)
    name = linear.strength_name("glass_transition")
    own = interval_over_models(model, model.model.names.index(name), values, sd)
    assert wide_intervals([model])[name] == (own["low"], own["high"])


def test_unknown_rests_on_the_final_model_alone() -> None:
    found = two_effects()
    verdict = replace(judge(found, np.random.default_rng(2)), kind="unknown")
    final = final_fits(verdict, None)
    assert final.leading == (found.end.key,)
    rows = candidate_records(found, verdict, final)
    stated = [row for row in rows if any(p.low_wide for p in row.parameters.values())]
    assert stated == [], "none of these effects has another form"


def test_two_effects_in_the_place_of_one_widen_the_interval_of_the_others() -> None:
    found = two_effects()
    verdict = judge(found, np.random.default_rng(2))
    other = fit_with(found.base, "c_T", "heater_ramp", "k_T")
    one = Exchange(("k_T",), ("heater_ramp", "k_T"), other)
    first = replace(verdict.findings[0], instead=(one,))
    final = final_fits(replace(verdict, findings=(first, *verdict.findings[1:])), None)
    assert other.key in final.leading
    rows = candidate_records(
        found, replace(verdict, findings=(first, *verdict.findings[1:])), final
    )
    (end,) = [row for row in rows if set(row.effects) == set(found.end.effects)]
    name = linear.strength_name("c_T")
    own = interval_over_models(other, other.model.names.index(name), *values_of(other))
    assert end.parameters[name].low_wide <= own["low"]
    assert end.parameters[name].high_wide >= own["high"]


def test_result_is_that_of_the_final_fits() -> None:
    # However large the error of coarse runs, the search takes them.
    settings = replace(Settings(), most_solver_error=1e9)
    described = study(effects=["k_T"])
    data = measured({"k_T": -1e-3}, 1)
    found = examine(described, data, advise=False, settings=settings)
    assert found.content.settings["most_solver_error"] == 1e9
    assert found.content.solver.coarsened
    assert found.end.effects == ("k_T",)
    searched, end = (fit.model.likelihood.problem.accuracy for fit in (found.search.end, found.end))
    assert (searched.cells, end.cells) == (12, 20)
    (best, *_) = found.content.candidates
    value = best.parameters["k_T_slope_1_K"].value
    assert value == found.end.strength("k_T") != found.search.end.strength("k_T")
    values, _ = values_of(found.end)
    extended = found.content.extended.parameters
    assert extended["rho"].value == values[found.end.model.names.index("rho")]
    likelihood = found.end.model.likelihood
    curves = likelihood.curves(found.end.fit.x)
    assert curves is not None
    assert np.array_equal(found.curves["after"], np.concatenate(likelihood.split(curves)))
