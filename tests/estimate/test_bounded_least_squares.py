"""Descents: their early end, and parameters that they keep."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from pyrofit.estimate.bounded_least_squares import Fit, minimise
from pyrofit.solver.arrays import FloatArray

Residuals = Callable[[FloatArray], FloatArray]
RNG = np.random.default_rng(3)
ROWS = RNG.standard_normal((40, 3))
TRUTH = np.array([0.4, 0.6, 0.5])


def bent(x: FloatArray) -> FloatArray:
    """Return residuals that are linear about the truth and bend away from it."""
    return 30.0 * (ROWS @ (x - TRUTH)) + 20.0 * (ROWS[:, :2] @ (x[:2] - TRUTH[:2]) ** 2)


def two_valleys(x: FloatArray) -> FloatArray:
    """Return residuals of two minima: 0 at x = 0.2, 1 at x = 0.8."""
    return np.array([20.0 * (x[0] - 0.2) * (x[0] - 0.8), 1.0 if x[0] > 0.5 else 0.0])


def differences(residuals: Residuals) -> Callable[[FloatArray, FloatArray], FloatArray]:
    """Return the derivatives of residuals by differences."""

    def jacobian(x: FloatArray, r: FloatArray) -> FloatArray:
        return np.column_stack([(residuals(x + d) - r) / 1e-6 for d in 1e-6 * np.eye(x.size)])

    return jacobian


def descend(residuals: Residuals, x: list[float], **options: Any) -> Fit:
    """Minimise to the end."""
    return minimise(residuals, differences(residuals), np.array(x), 1e-6, **options)


def test_descent_that_comes_back_to_a_known_fit_ends_early() -> None:
    known = descend(bent, [0.5, 0.5, 0.5])
    found = descend(bent, [0.9, 0.1, 0.9], known=known)
    assert found.returned
    assert 0.0 < found.chi2 - known.chi2 < 50.0
    whole = descend(bent, [0.9, 0.1, 0.9])
    assert not whole.returned
    assert whole.chi2 == pytest.approx(known.chi2, abs=1e-6)


@pytest.mark.parametrize(("start", "end"), [(0.1, 0.2), (0.35, 0.2), (0.95, 0.8)])
def test_descent_to_another_valley_goes_on(start: float, end: float) -> None:
    known = descend(two_valleys, [1.0 - end])
    found = descend(two_valleys, [start], known=known)
    assert not found.returned
    assert found.x.item() == pytest.approx(end, abs=1e-3)


def test_descent_does_not_return_to_a_fit_with_old_derivatives() -> None:
    old = descend(bent, [0.5, 0.5, 0.5])
    old = Fit(old.chi2, old.x, old.residuals, old.jacobian, fresh=False)
    assert not descend(bent, [0.9, 0.1, 0.9], known=old).returned


def test_idle_parameter_stays_and_keeps_its_derivatives() -> None:
    def with_idle(x: FloatArray) -> FloatArray:
        return np.append(bent(x[:3]), 2.0 * (x[3] - 0.3))

    found = descend(with_idle, [0.9, 0.1, 0.9, 0.3], idle=(3,))
    alone = descend(bent, [0.9, 0.1, 0.9])
    assert found.x[3] == 0.3
    assert found.x[:3] == pytest.approx(alone.x, abs=1e-9)
    assert found.jacobian.shape == (41, 4)
    assert found.jacobian[40, 3] == pytest.approx(2.0, rel=1e-6)
    assert not found.jacobian[:40, 3].any()


def valley(x: FloatArray) -> FloatArray:
    """Return the residuals of Rosenbrock's function (doi 10.1093/comjnl/3.3.175) of 4 x - 2."""
    u, v = 4.0 * x - 2.0
    return np.array([10.0 * (v - u**2), 1.0 - u])


def counted(
    residuals: Residuals,
) -> tuple[Callable[[FloatArray, FloatArray], FloatArray], list[FloatArray]]:
    """Return the derivatives of residuals, and a list of the points where they were made."""
    made: list[FloatArray] = []

    def jacobian(x: FloatArray, r: FloatArray) -> FloatArray:
        made.append(x)
        return differences(residuals)(x, r)

    return jacobian, made


def test_derivatives_at_hand_are_confirmed_at_the_end_only() -> None:
    def straight(x: FloatArray) -> FloatArray:
        return ROWS @ (x - TRUTH)

    jacobian, made = counted(straight)
    start = np.array([0.9, 0.1, 0.9])
    found = minimise(straight, jacobian, start, 1e-6, begin=ROWS)
    assert found.x == pytest.approx(TRUTH, abs=1e-3)
    assert len(made) == 1
    assert found.fresh


@pytest.mark.parametrize("start", RNG.random((20, 2)).tolist())
@pytest.mark.parametrize("steep", [10.0, 30.0])
def test_curved_valley_is_followed_to_its_end_and_not_given_up(
    start: list[float], steep: float
) -> None:
    """A step shortened by the bend of a valley promises little: that is not the end of it."""
    scale = np.array([0.3 * steep, 3.0])
    jacobian, made = counted(lambda x: scale * valley(x))
    found = minimise(lambda x: scale * valley(x), jacobian, np.array(start), 0.05)
    assert found.chi2 < 0.1
    assert len(made) <= 25


def test_derivatives_that_mislead_are_made_anew() -> None:
    jacobian, made = counted(valley)
    wrong = np.array([[1.0, 2.0], [-30.0, 1.0]])
    found = minimise(valley, jacobian, np.array([0.2, 0.75]), 1e-6, begin=wrong)
    assert found.x == pytest.approx([0.75, 0.75], abs=1e-3)
    assert made[0].tolist() == [0.2, 0.75]


@pytest.mark.parametrize("radius", [1e-3, 0.03, 0.5])
def test_no_step_is_longer_than_it_is_trusted_to_be(radius: float) -> None:
    asked: list[FloatArray] = []

    def straight(x: FloatArray) -> FloatArray:
        asked.append(x)
        return 30.0 * (ROWS @ (x - TRUTH))

    minimise(straight, differences(straight), np.array([0.9, 0.1, 0.9]), 1e-6, first_radius=radius)
    ahead = next(x for x in asked if np.abs(x - asked[0]).max() > 1e-5)
    assert np.linalg.norm(ahead - asked[0]) <= 1.3 * radius


@pytest.mark.parametrize("seed", range(20))
def test_parameters_that_do_the_same_do_not_end_a_descent(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows = 10.0 ** rng.uniform(0.0, 4.0) * rng.standard_normal((60, 5))
    rows[:, 1], rows[:, 3] = rows[:, 0], 0.5 * rows[:, 2]
    target = rows @ np.full(5, 0.4)
    found = descend(lambda x: rows @ x - target, rng.random(5).tolist(), ridge=1e-12)
    assert found.chi2 < 1e-4


def test_held_parameter_stays_with_derivatives_at_hand() -> None:
    start, slopes = np.array([0.9, 0.1, 0.9]), 30.0 * ROWS
    found = descend(bent, start.tolist(), begin=slopes, fixed=1)
    assert found.x[1] == 0.1
    assert found.x == pytest.approx(descend(bent, start.tolist(), fixed=1).x, abs=1e-4)
    assert np.array_equal(slopes, 30.0 * ROWS)
