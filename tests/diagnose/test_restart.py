"""Fits that start anew where a base fit lies in the wrong of two valleys."""

from dataclasses import dataclass, fields, replace

import linear
import numpy as np
import pytest
from linear import TOTAL, column_of

from pyrofit.diagnose.base.descent import descend_chi_square, refreshed
from pyrofit.diagnose.base.fit import apart
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import Base, model_of, strength_of
from pyrofit.diagnose.search.restart import from_other_starts, restarted
from pyrofit.diagnose.search.step import SearchContext
from pyrofit.estimate.problem import Outcome
from pyrofit.solver.arrays import FloatArray, Status

COLUMNS = linear.random_columns(6, "k_T", size=60.0)
WIDE, NARROW = (
    400.0 * column / np.linalg.norm(column) for column in (COLUMNS["rho"], COLUMNS["k"])
)
CONTEXT = SearchContext(np.random.default_rng(1))
RIGHT, WRONG = 0.25, 0.75
"""Fractions of rho in the middle of the deeper valley and of the other one: rho of -5 and 5."""


@dataclass(frozen=True)
class Valleys(linear.Linear):
    """Curves of two valleys: a (r^2 - 1) + b (r + 1)/2, r = rho/5, is zero only at r = -1."""

    def _simulated_one(self, x: FloatArray) -> Outcome:
        r = float(x[0]) / 5.0
        total = WIDE * (r**2 - 1.0) + NARROW * 0.5 * (r + 1.0)
        for name, value in zip(self.names[1:], x[1:].tolist(), strict=True):
            total = total + value * self.columns.get(name, 0.0)
        parts = dict(zip(linear.CHANNELS, np.split(total, len(linear.CHANNELS)), strict=True))
        return Status.OK, [parts[name, signal] for name, signal, _ in self.picks]


def base_of_two_valleys() -> Base:
    y = np.random.default_rng(1).standard_normal(TOTAL)
    y += 0.8 * strength_of("k_T")[1].typical * column_of(COLUMNS, "k_T")
    base = linear.base({**COLUMNS, "k": 0.0 * COLUMNS["k"]}, y)
    problem = base.likelihood.problem
    parts = {field.name: getattr(problem, field.name) for field in fields(problem)}
    return replace(base, likelihood=replace(base.likelihood, problem=Valleys(**parts)))


def fit_from(base: Base, rho: float, *effects: str) -> FittedModel:
    model = model_of(base, {effect: (strength_of(effect)[0],) for effect in effects})
    x = np.full(len(model.names), 0.5)
    x[0] = rho
    return FittedModel(model, refreshed(model, descend_chi_square(model, x)))


@pytest.fixture(scope="module")
def base() -> Base:
    return base_of_two_valleys()


def test_there_are_two_valleys(base: Base) -> None:
    right, wrong = fit_from(base, RIGHT), fit_from(base, WRONG)
    assert right.fit.x[0] == pytest.approx(RIGHT, abs=0.02)
    assert wrong.fit.x[0] == pytest.approx(WRONG, abs=0.05)
    assert wrong.fit.chi2 > right.fit.chi2 + 1e4


def test_model_is_fitted_again_from_where_a_further_effect_leads(base: Base) -> None:
    start, trial = fit_from(base, WRONG), fit_from(base, RIGHT, "k_T")
    (found,) = restarted([(start, [trial])], CONTEXT)
    assert found.effects == ()
    assert found.fit.x[0] == pytest.approx(RIGHT, abs=0.02)
    assert found.fit.chi2 == pytest.approx(fit_from(base, RIGHT).fit.chi2, abs=0.1)


def test_model_in_the_same_valley_stays_as_it_is(base: Base) -> None:
    start = fit_from(base, RIGHT)
    other = fit_from(base, WRONG)
    found = restarted(
        [(start, [fit_from(base, RIGHT, "k_T")]), (other, [fit_from(base, RIGHT, "k_T")])], CONTEXT
    )
    assert found[0] is start
    assert found[1].fit.chi2 < other.fit.chi2


def test_leading_effects_are_fitted_from_other_starts_where_they_misfit(base: Base) -> None:
    stuck = fit_from(base, WRONG, "k_T")
    context = replace(CONTEXT, other_starts=(np.array([RIGHT, 0.5]),))
    (found,) = from_other_starts([stuck], context)
    assert found.effects == ("k_T",)
    assert found.fit.chi2 < stuck.fit.chi2 - 1e4
    assert from_other_starts([stuck], CONTEXT) == []
    assert from_other_starts([found], context) == []


def test_ends_of_different_valleys_are_other_starts() -> None:
    assert apart([10.0, 10.1, 10.3, 40.0, 40.2, 90.0], 0.5) == [0, 3, 5]
    assert apart([10.0], 0.5) == [0]
