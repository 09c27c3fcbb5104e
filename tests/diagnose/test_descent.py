"""The descent: least squares within limits, on functions whose least value is known."""

from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from pyrofit.diagnose.base.descent import descend_chi_square, refreshed
from pyrofit.diagnose.settings import Settings
from pyrofit.numerics.linear import dot
from pyrofit.solver.arrays import FloatArray

Function = Callable[[FloatArray], FloatArray]


@dataclass
class Fake:
    """A model of any residual function; keeps what was asked."""

    function: Function
    asked: list[FloatArray] = field(default_factory=list)
    idle: tuple[int, ...] = ()
    base: SimpleNamespace = field(
        default_factory=lambda: SimpleNamespace(journal=None, settings=Settings())
    )

    def with_idle_known(self, x: FloatArray, fixed: int | None) -> FloatArray:
        return x

    def residuals(self, x: FloatArray) -> FloatArray:
        self.asked.append(x.copy())
        return self.function(x)

    def jacobian(self, x: FloatArray, residuals: FloatArray) -> FloatArray:
        by = np.where(x < 0.5, 1e-6, -1e-6)
        rows = [
            (self.residuals(x + by * row) - residuals) / by[i]
            for i, row in enumerate(np.eye(x.size))
        ]
        return np.column_stack(rows)


def fake(function: Function) -> Any:
    return Fake(function)


def rosenbrock(x: FloatArray) -> FloatArray:
    """Rosenbrock's valley, least and zero at 0.75 of the limits, -2 to 2 each."""
    u, v = 4.0 * x - 2.0
    return 30.0 * np.array([10.0 * (v - u**2), 1.0 - u])


def linear(A: FloatArray, y: FloatArray) -> Function:
    return lambda x: A @ x - y


STARTS = [(0.2, 0.75), (0.5, 0.5), (0.95, 0.05), (0.05, 0.95), (0.75, 0.2), (0.0, 1.0)]


@pytest.mark.parametrize("start", STARTS)
def test_curved_valley_is_followed_to_its_lowest_point_from_every_side(
    start: tuple[float, float],
) -> None:
    end = descend_chi_square(fake(rosenbrock), np.array(start))
    assert end.chi2 < Settings().converged_gain
    assert end.x == pytest.approx([0.75, 0.75], abs=0.01)


def test_linear_model_ends_at_the_normal_equations_solution() -> None:
    rng = np.random.default_rng(1)
    A, inside = 20.0 * rng.standard_normal((30, 4)), np.array([0.3, 0.6, 0.5, 0.7])
    y = A @ inside + 0.1 * rng.standard_normal(30)
    exact = np.linalg.lstsq(A, y, rcond=None)[0]
    for start in (np.zeros(4), np.ones(4)):
        end = descend_chi_square(fake(linear(A, y)), start)
        assert end.x == pytest.approx(exact, abs=1e-3)
        assert end.chi2 == pytest.approx(
            float(np.sum((A @ exact - y) ** 2)), abs=Settings().converged_gain
        )


def test_fixed_parameter_keeps_its_value_and_the_others_are_best_beside_it() -> None:
    rng = np.random.default_rng(1)
    A, y = 20.0 * rng.standard_normal((30, 4)), 20.0 * rng.standard_normal(30)
    start = np.array([0.5, 0.3, 0.5, 0.5])
    end = descend_chi_square(
        fake(linear(A, A @ np.array([0.4, 0.7, 0.6, 0.5]) + 0.05 * y)), start, fixed=1
    )
    assert end.x[1] == 0.3
    rest = [0, 2, 3]
    target = A @ np.array([0.4, 0.7, 0.6, 0.5]) + 0.05 * y - 0.3 * A[:, 1]
    exact = np.linalg.lstsq(A[:, rest], target, rcond=None)[0]
    assert np.all((exact > 0.0) & (exact < 1.0))
    assert end.x[rest] == pytest.approx(exact, abs=2e-3)


def test_rough_descent_asks_less_and_ends_near() -> None:
    rough, fine = fake(rosenbrock), fake(rosenbrock)
    ends = [
        descend_chi_square(model, np.array([0.2, 0.75]), enough=enough)
        for model, enough in ((rough, 5.0), (fine, Settings().converged_gain))
    ]
    assert len(rough.asked) < len(fine.asked)
    assert ends[1].chi2 <= ends[0].chi2


@pytest.mark.parametrize("seed", range(8))
def test_parameters_rest_exactly_at_limits_and_the_others_are_best_beside_them(seed: int) -> None:
    rng = np.random.default_rng(seed)
    A = 20.0 * rng.standard_normal((30, 4))
    y = A @ np.array([1.3, -0.2, 0.4, 0.6]) + rng.standard_normal(30)
    bounded = lsq_linear(A, y, (0.0, 1.0), method="bvls")
    end = descend_chi_square(fake(linear(A, y)), rng.uniform(0.1, 0.9, 4))
    assert set(np.flatnonzero(end.x == 1.0)) == set(np.flatnonzero(bounded.active_mask == 1))
    assert set(np.flatnonzero(end.x == 0.0)) == set(np.flatnonzero(bounded.active_mask == -1))
    assert bounded.active_mask.any()
    assert end.chi2 == pytest.approx(2.0 * bounded.cost, abs=Settings().converged_gain)
    assert end.x == pytest.approx(bounded.x, abs=5e-3)


def test_parameter_leaves_a_limit_that_it_starts_at() -> None:
    A, y = 20.0 * np.eye(2), np.array([8.0, 12.0])
    end = descend_chi_square(fake(linear(A, y)), np.array([0.0, 1.0]))
    assert end.x == pytest.approx([0.4, 0.6], abs=1e-3)


def beyond(x: FloatArray) -> FloatArray:
    """Return Rosenbrock's valley with its lowest point out of reach, at 1.15 and 0.45."""
    return rosenbrock(x + np.array([-0.4, 0.3]))


@pytest.mark.parametrize("start", STARTS)
def test_nothing_outside_the_limits_is_ever_simulated(start: tuple[float, float]) -> None:
    model = fake(beyond)
    descend_chi_square(model, np.array(start))
    asked = np.array(model.asked)
    assert asked.min() >= 0.0
    assert asked.max() <= 1.0


@pytest.mark.parametrize("start", STARTS)
def test_valley_that_leaves_the_limits_is_followed_until_there(start: tuple[float, float]) -> None:
    """A step cut off at one limit after the other promised next to nothing, and was the last."""
    end = descend_chi_square(fake(beyond), np.array(start))
    # Best at u = 0.4 and v = u^2.
    assert end.x == pytest.approx([1.0, 0.24], abs=1e-3)
    assert end.chi2 == pytest.approx(18.0**2, abs=Settings().converged_gain)


def test_start_outside_the_limits_is_brought_within() -> None:
    model = fake(linear(20.0 * np.eye(2), np.array([8.0, 12.0])))
    end = descend_chi_square(model, np.array([-3.0, 7.0]))
    assert model.asked[0].tolist() == [0.0, 1.0]
    assert end.x == pytest.approx([0.4, 0.6], abs=1e-3)


@pytest.mark.parametrize("seed", range(20))
def test_end_is_never_above_the_start_even_with_misleading_derivatives(seed: int) -> None:
    rng = np.random.default_rng(seed)
    wild = 10.0 * rng.standard_normal((12, 3))
    phase = rng.uniform(0.0, 6.0, 12)
    model = fake(lambda x: 5.0 * np.sin(wild @ x + phase))
    start, wrong = rng.uniform(0.0, 1.0, 3), rng.standard_normal((12, 3))
    end = descend_chi_square(model, start, wrong)
    before = model.function(start)
    assert end.chi2 < before @ before  # no start is stationary: something is gained, too
    assert end.residuals.tolist() == model.function(end.x).tolist()
    assert end.chi2 == dot(end.residuals, end.residuals)


def test_wrong_derivatives_to_begin_with_lead_to_the_same_end() -> None:
    A, y = 20.0 * np.eye(2), np.array([8.0, 12.0])
    start = np.array([0.9, 0.1])
    end = descend_chi_square(fake(linear(A, y)), start, np.array([[-5.0, 30.0], [10.0, -1.0]]))
    assert end.x == pytest.approx([0.4, 0.6], abs=2e-3)


def test_parameter_that_changes_nothing_stays_where_it_is() -> None:
    A = np.column_stack([20.0 * np.ones(5), np.zeros(5)])
    end = descend_chi_square(fake(linear(A, np.full(5, 10.0))), np.array([0.1, 0.37]))
    assert end.x == pytest.approx([0.5, 0.37], abs=1e-3)
    assert end.x[1] == 0.37


def test_two_parameters_that_do_the_same_are_no_obstacle() -> None:
    A = 20.0 * np.ones((5, 2))
    end = descend_chi_square(fake(linear(A, np.full(5, 18.0))), np.array([0.1, 0.2]))
    assert end.chi2 < Settings().converged_gain
    assert end.x.sum() == pytest.approx(0.9, abs=1e-3)


def test_refreshed_derivatives_are_those_at_the_end() -> None:
    model = fake(rosenbrock)
    end = descend_chi_square(model, np.array([0.2, 0.75]))
    u = 4.0 * end.x[0] - 2.0
    exact = 120.0 * np.array([[-20.0 * u, 10.0], [-1.0, 0.0]])
    again = refreshed(model, end)
    assert again.jacobian == pytest.approx(exact, rel=1e-3)
    assert again.fresh
    assert again.x is end.x
    assert refreshed(model, again) is again
