"""Free corrections in the place of an effect: the missing one may be outside the catalogue."""

from dataclasses import fields

import linear
import numpy as np
import pytest
from linear import column_of, fit_with

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.inflation import Inflation, none_for
from pyrofit.diagnose.base.model import strength_of
from pyrofit.diagnose.corrections.correction import Correction
from pyrofit.diagnose.corrections.forms import SAME_TERM
from pyrofit.diagnose.judge import other_terms as module
from pyrofit.diagnose.judge.findings import Verdict
from pyrofit.diagnose.judge.other_terms import OtherTerm, other_terms
from pyrofit.diagnose.judge.verdict import judge
from pyrofit.diagnose.result.verdict_text import sentences
from pyrofit.diagnose.search.step import SearchContext
from pyrofit.diagnose.search.stepwise import search_effects
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.estimate.problem import Problem
from pyrofit.solver.arrays import FloatArray

EFFECTS = ("c_T", "k_T")
COLUMNS = linear.random_columns(6, *EFFECTS, "back_loss", size=60.0)
WORDS = "another heat loss of the front over its temperature"
Y = (
    np.random.default_rng(1).standard_normal(linear.TOTAL)
    + 2.0 * COLUMNS["rho"]
    - COLUMNS["k"]
    + 0.8 * strength_of("k_T")[1].typical * column_of(COLUMNS, "k_T")
)


class Corrected(linear.Linear):
    """A linear problem that uses all its parameters."""

    @property
    def moving(self) -> tuple[int, ...]:
        return tuple(range(len(self.names)))


def correction(problem: Problem, column: FloatArray, probe: str = "front_heat_loss") -> Correction:
    """A correction with one coefficient, which adds a column to the curves."""
    assert isinstance(problem, linear.Linear)
    parts = {field.name: getattr(problem, field.name) for field in fields(problem)}
    wider = Corrected(**{**parts, "columns": {**problem.columns, "c": column}})
    return Correction(probe, WORDS, "-", {"c": 1.0}, wider, lambda values: [])


def like_k_T(share: float) -> FloatArray:
    """A column that is that of k_T in part, the rest that of another effect."""
    columns = column_of(COLUMNS, "k_T"), column_of(COLUMNS, "back_loss")
    mine, other = (
        strength_of(name)[1].typical * column
        for name, column in zip(("k_T", "back_loss"), columns, strict=True)
    )
    return np.asarray(share * mine + (1.0 - share) * other)


def offered(monkeypatch: pytest.MonkeyPatch, share: float, probe: str = "front_heat_loss") -> None:
    monkeypatch.setattr(
        module,
        "fitted_corrections",
        lambda trial: [correction(trial.model.likelihood.problem, like_k_T(share), probe)],
    )


def models() -> tuple[FittedModel, FittedModel]:
    base = linear.fit(COLUMNS, Y)
    return fit_with(base, "k_T"), base


def verdict() -> Verdict:
    context = SearchContext(np.random.default_rng(1))
    return judge(
        search_effects(linear.fit(COLUMNS, Y), EFFECTS, 3, context), np.random.default_rng(2)
    )


def test_correction_that_does_the_same_fits_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, share=1.0)
    end, base = models()
    ((found,),) = other_terms(end, [base], none_for(end))
    assert found.words == WORDS
    assert abs(found.above) < 9.0
    assert found.fits_as_well


def test_correction_that_does_something_else_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, share=0.0)
    end, base = models()
    ((found,),) = other_terms(end, [base], none_for(end))
    assert not found.fits_as_well
    assert found.above > 0.9 * (base.fit.chi2 - end.fit.chi2) - 20.0


def test_certainty_needs_odds_of_22_000_to_1() -> None:
    limit, most = 2.0 * np.log(22_000.0), Settings().certain_evidence
    assert OtherTerm(WORDS, limit - 0.1, most).fits_as_well
    assert not OtherTerm(WORDS, limit + 0.1, most).fits_as_well


def test_correction_of_the_same_term_is_no_other_one(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, share=1.0, probe="conductivity")
    end, base = models()
    assert other_terms(end, [base], none_for(end)) == [[]]


def test_marginal_likelihood_of_one_coefficient_by_hand(monkeypatch: pytest.MonkeyPatch) -> None:
    """-2 ln Z of two models that fit alike differs by the widths of their priors alone."""
    offered(monkeypatch, share=1.0)
    end, base = models()
    ((found,),) = other_terms(end, [base], none_for(end))
    q = strength_of("k_T")[1]
    # Search range in typical strengths, which are the unit of the column.
    uniform = (q.upper - q.lower) / abs(q.typical)
    normal = 6.0 / np.sqrt(12.0 + 36.0)  # standard deviation of both priors of the coefficient
    wider = 2.0 * np.log(uniform / np.sqrt(12.0)) - 2.0 * np.log(normal)
    prior_of_coefficient = 0.8**2  # it is 0.8 standard deviations from zero
    assert found.above == pytest.approx(prior_of_coefficient - wider, abs=0.3)


def test_effect_that_another_term_replaces_is_not_certain(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, share=1.0)
    found = verdict()
    assert found.kind == "ambiguous"
    assert not found.confirmed
    assert found.findings[0].effects == ["k_T"]
    assert found.reasons == (
        f"slope of the conductivity may be replaced by {WORDS}, with nearly as good a fit",
        "the reason may be an effect outside the catalogue",
    )
    assert "seems to lack" in sentences(found)


def test_effect_that_no_other_term_replaces_is_certain(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, share=0.5)
    found = verdict()
    assert found.kind == "named", found.reasons
    assert found.confirmed
    assert [other.words for other in found.findings[0].others] == [WORDS]


def test_correction_replaces_the_one_of_two_effects_that_it_is_like(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    offered(monkeypatch, share=1.0)
    q = strength_of("c_T")[1]
    base = linear.fit(COLUMNS, Y + 0.7 * q.typical * column_of(COLUMNS, "c_T"))
    end = fit_with(base, "c_T", "k_T")
    without = [fit_with(base, "k_T"), fit_with(base, "c_T")]
    of_c_T, of_k_T = other_terms(end, without, none_for(end))
    assert [other.fits_as_well for other in (*of_c_T, *of_k_T)] == [False, True]


def test_misfit_makes_differences_count_less(monkeypatch: pytest.MonkeyPatch) -> None:
    offered(monkeypatch, share=0.0)
    end, base = models()
    ((plain,),) = other_terms(end, [base], none_for(end))
    ((inflated,),) = other_terms(end, [base], Inflation((100.0,) * 4))
    assert 0.0 < inflated.above < 0.05 * plain.above


def test_groups_of_the_same_term_are_those_of_the_catalogue() -> None:
    groups = {effect.group for effect in known_effects().values()}
    assert {group for named in SAME_TERM.values() for group in named} <= groups
