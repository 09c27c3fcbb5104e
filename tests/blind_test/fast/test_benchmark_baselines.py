"""The choices of the baselines, without a run of the solver."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.search.score_test import Screening
from pyrofit_blind_test.benchmark import baselines
from pyrofit_blind_test.benchmark.baselines import paying, sparse, thresholded

POINTS = 400


def columns(count: int) -> Any:
    """Return columns of norm 1, nearly at right angles."""
    found = np.random.default_rng(1).standard_normal((POINTS, count))
    return found / np.sqrt(np.sum(found**2, axis=0))


def test_sparse_regression_keeps_the_columns_of_the_target() -> None:
    X = columns(12)
    found = thresholded(X, 9.0 * X[:, 2] - 6.0 * X[:, 7], 3.5)
    assert set(found) == {2, 7}
    # The ridge of 0.05 takes 5 % from each.
    assert found[2][0] == pytest.approx(9.0 / 1.05, rel=0.02)
    assert found[7][0] == pytest.approx(-6.0 / 1.05, rel=0.02)
    assert found[2][1] == pytest.approx(1.0 / np.sqrt(1.05), rel=0.01)


def test_sparse_regression_keeps_nothing_of_noise() -> None:
    noise = np.random.default_rng(2).standard_normal(POINTS)
    assert thresholded(columns(12), noise, 4.0) == {}


def look(effect: str, strength: float, change: Any) -> Screening:
    changes = change[:, None]
    none = np.zeros(1)
    return Screening(effect, np.array([strength]), changes, changes, none, 0)


def base(residuals: Any) -> FittedModel:
    fit = SimpleNamespace(residuals=residuals)
    return cast("FittedModel", SimpleNamespace(fit=fit, model=SimpleNamespace(points=POINTS)))


def test_sparse_regression_finds_the_strength_of_an_effect() -> None:
    X = columns(3)
    looks = [
        look("k_T", 1e-4, 2.0 * X[:, 0]),
        look("in_depth", 1e-5, 2.0 * X[:, 1]),
        look("back_loss", 1.1, 2.0 * X[:, 2]),
    ]
    # The measurement is that of five times the small strength, so the base is below by as much.
    (row,) = sparse(base(-10.0 * X[:, 0]), looks)
    assert (row["effect"], row["sure"]) == ("k_T", 0)
    assert row["strength"] == pytest.approx(5e-4 / 1.05, rel=0.01)
    assert row["low"] < row["strength"] < row["high"]
    # An absorption length below zero is none.
    assert sparse(base(10.0 * X[:, 1]), looks) == baselines.NONE
    # The factor of the back loss is 1 where the effect vanishes.
    (row,) = sparse(base(-10.0 * X[:, 2]), looks)
    assert row["strength"] == pytest.approx(1.0 + 0.5 / 1.05, rel=0.01)


def test_sparse_regression_names_at_most_two_effects() -> None:
    X = columns(3)
    names = ("k_T", "c_T", "flux_drift")
    looks = [look(name, 1e-6, 0.1 * X[:, k]) for k, name in enumerate(names)]
    rows = sparse(base(-8.0 * X[:, 0] - 9.0 * X[:, 1] - 10.0 * X[:, 2]), looks)
    assert [row["effect"] for row in rows] == ["c_T", "flux_drift"]


def test_sparse_regression_leaves_out_what_changes_nothing() -> None:
    flat = look("k_T", 1e-4, np.zeros(POINTS))
    assert sparse(base(np.ones(POINTS)), [flat]) == baselines.NONE


def taken(*steps: tuple[str, float, float]) -> list[tuple[FittedModel, float]]:
    """Return models of one effect more each, from its name, chi-square and lead over a rival."""
    found: list[tuple[FittedModel, float]] = []
    effects: tuple[str, ...] = ()
    for name, chi2, ahead in steps:
        effects = (*effects, name) if name else ()
        fit = SimpleNamespace(chi2=chi2)
        found.append((cast("FittedModel", SimpleNamespace(fit=fit, effects=effects)), ahead))
    return found


@pytest.mark.parametrize(
    ("price", "expected"),
    [
        (2.0, [("k_T", 1), ("c_T", 0)]),
        (6.0, [("k_T", 1)]),  # the second lowers chi-square by 5
        (30.0, [("", 0)]),
    ],
)
def test_forward_selection_stops_where_an_effect_does_not_pay(
    price: float, expected: list[tuple[str, int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(baselines, "strength_row", lambda m, e, sure: {"effect": e, "sure": sure})
    steps = taken(("", 100.0, np.inf), ("k_T", 75.0, 11.0), ("c_T", 70.0, 1.0))
    assert [(row["effect"], row["sure"]) for row in paying(steps, price)] == expected


def test_a_name_with_a_near_rival_is_not_sure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(baselines, "strength_row", lambda m, e, sure: {"effect": e, "sure": sure})
    (row,) = paying(taken(("", 100.0, np.inf), ("k_T", 40.0, 9.0)), 2.0)
    assert row["sure"] == 0
