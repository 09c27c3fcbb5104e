"""From where an effect is fitted, and when that is enough; descents end where the test says."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

import linear
import numpy as np
import pytest

from pyrofit.diagnose.base import fitted
from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.fitted import polished
from pyrofit.diagnose.base.model import extended, strength_of
from pyrofit.diagnose.search import refit
from pyrofit.diagnose.search.refit import from_best_start, from_elsewhere, look_at
from pyrofit.diagnose.search.score_test import Screening, strengths_tried
from pyrofit.diagnose.settings import Settings
from pyrofit.solver.arrays import FloatArray

# The data say next to nothing of k, so that it is wide.
COLUMNS = {**linear.random_columns(3, "k_T"), "k": np.full(linear.TOTAL, 1e-6)}
Y = np.random.default_rng(1).standard_normal(linear.TOTAL)


@pytest.fixture
def ends(monkeypatch: pytest.MonkeyPatch) -> Callable[[Iterable[float]], list[FloatArray]]:
    """Let descents end with given chi-squares, one after the other; return where they started."""

    def planned(chi2: Iterable[float]) -> list[FloatArray]:
        waiting: Iterator[float] = iter(chi2)
        begun: list[FloatArray] = []

        def descend(
            model: object,
            x: FloatArray,
            jacobian: FloatArray | None = None,
            enough: float | None = None,
            known: Fit | None = None,
        ) -> Fit:
            begun.append(x)
            return replace(trial().fit, x=x, chi2=next(waiting))

        for module in (fitted, refit):
            monkeypatch.setattr(module, "descend_chi_square", descend)
        monkeypatch.setattr(fitted, "followed", lambda trial: trial)
        return begun

    return planned


def trial() -> linear.FittedModel:
    return linear.fit(COLUMNS, Y)


def test_search_from_elsewhere_goes_on_while_it_lowers_but_not_for_ever(
    ends: Callable[[Iterable[float]], list[FloatArray]],
) -> None:
    given = trial()
    wide = len(list(fitted._elsewhere(given)))
    assert wide >= 2
    for falls, rounds in (
        ([0.0], 1),
        ([0.5 * Settings().same_valley], 1),
        ([2.0, 0.0], 2),
        ([2.0] * 9, 3),
    ):
        lowest = given.fit.chi2
        planned = []
        for fall in falls:
            lowest -= fall
            planned += [lowest, *[lowest + 1.0] * (wide - 1)]
        begun = ends(planned)
        (found,) = polished([given])
        assert len(begun) == rounds * wide
        assert found.fit.chi2 == pytest.approx(given.fit.chi2 - sum(falls[:rounds]))


def test_starts_are_the_most_promising_strength_a_strong_one_and_the_other_side() -> None:
    seen = two_sided = look_at(trial(), ["k_T"])[0]
    typical = strength_of("k_T")[1].typical
    for promising in range(seen.strengths.size):
        ahead = np.arange(seen.strengths.size) != promising
        seen = replace(two_sided, ahead=ahead.astype(float))
        found = [seen.strengths[i] / typical for i in refit.starts(seen)]
        asked = [seen.strengths[promising] / typical, max(seen.strengths / typical), -1.0]
        assert found == pytest.approx(list(dict.fromkeys(asked)))


def test_starts_of_an_effect_with_one_sign_hold_the_typical_strength() -> None:
    seen = Screening(
        "in_depth",
        strengths_tried("in_depth", Settings().tried_strengths, Settings().near_limit),
        *np.zeros((2, 3, 4)),
        np.array([1.0, 2.0, 3.0, 4.0]),
        2,
    )
    _, quantity = strength_of("in_depth")
    found = seen.strengths[refit.starts(seen)]
    assert found[0] == seen.strengths.min()
    assert found[1:].tolist() == [seen.strengths.max(), pytest.approx(quantity.typical)]


def test_starts_end_once_two_lead_to_the_same_valley(
    ends: Callable[[Iterable[float]], list[FloatArray]],
) -> None:
    given = trial()
    (seen,) = look_at(given, ["k_T"])
    best = given.fit.chi2
    assert len(refit.starts(seen)) == 3
    for chi2, tried_starts in (
        ([best - 20.0, best - 20.1, best - 30.0], 2),
        ([best - 20.0, best - 25.0, best - 30.0], 3),
    ):
        begun = ends(chi2)
        first = from_best_start(given, seen)
        assert first.fit.chi2 == chi2[0]
        found = from_elsewhere(given, seen, first, refit.starts(seen)[1:])
        assert len(begun) == tried_starts
        assert found.fit.chi2 == min(chi2[:tried_starts])


def test_effect_whose_start_leads_nowhere_is_fitted_from_where_it_is_absent(
    ends: Callable[[Iterable[float]], list[FloatArray]],
) -> None:
    given = trial()
    (seen,) = look_at(given, ["k_T"])
    begun = ends([given.fit.chi2 + 5.0, given.fit.chi2 - 3.0])
    found = from_best_start(given, seen)
    assert found.fit.chi2 == given.fit.chi2 - 3.0
    assert begun[1] == pytest.approx(extended(given.fit.x, "k_T", strength_of("k_T")[1].value))


def test_derivatives_at_hand_are_those_of_a_linear_model() -> None:
    given = trial()
    (seen,) = look_at(given, ["k_T"])
    model = refit.model_with(given, "k_T")
    for at in range(len(seen.strengths)):
        x = refit._start(given, seen, at)
        expected = model.jacobian(x, model.residuals(x))
        assert refit._derivatives(given, seen, at) == pytest.approx(expected, abs=1e-6)
