"""Differences on curves whose derivatives are known, at limits and beside runs that fail."""

import math

import numpy as np
import pytest

from pyrofit.estimate.derivatives import LEAST, PARABOLA, SECANT, Curves, Difference, derivatives
from pyrofit.solver.arrays import FloatArray

TIME = np.linspace(0.0, 1.0, 7)
EDGES = [0.0, 1e-6, 0.001, 0.3, 0.4999, 0.5, 0.999, 1.0 - 1e-6, 1.0]


def quadratic(x: FloatArray) -> FloatArray:
    """Return a curve that is a parabola in each parameter."""
    return np.asarray(x[0] ** 2 * TIME + (x[1] - 0.3) ** 2 + x[0] * x[1])


def exact(x: FloatArray) -> FloatArray:
    return np.column_stack([2.0 * x[0] * TIME + x[1], 2.0 * (x[1] - 0.3) + x[0] + 0.0 * TIME])


def watched(asked: list[FloatArray], fails: float = math.inf) -> Curves:
    """Return curves that keep what they were asked; none where x_0 is above ``fails``."""

    def curves(X: FloatArray) -> list[FloatArray | None]:
        asked.extend(X)
        return [None if x[0] > fails else quadratic(x) for x in X]

    return curves


@pytest.mark.parametrize("a", EDGES)
@pytest.mark.parametrize("b", [0.0, 0.7, 1.0])
def test_parabola_is_exact_for_parabolas_everywhere_within_the_limits(a: float, b: float) -> None:
    asked: list[FloatArray] = []
    x = np.array([a, b])
    J, found = derivatives(watched(asked), x, quadratic(x), PARABOLA)
    assert pytest.approx(exact(x), abs=1e-8) == J
    assert found.all()
    assert np.min(asked) >= 0.0
    assert np.max(asked) <= 1.0


@pytest.mark.parametrize("a", EDGES)
def test_secant_is_towards_the_farther_limit(a: float) -> None:
    asked: list[FloatArray] = []
    x = np.array([a, 0.2])
    J, _ = derivatives(watched(asked), x, quadratic(x), SECANT)
    h = SECANT.step if a < 0.5 else -SECANT.step
    assert len(asked) == 3
    assert asked[1].tolist() == [a + h, 0.2]
    # Of a parabola the secant is off by h times half of the second derivative.
    rounding = 2.0 * float(np.finfo(float).eps) / SECANT.step
    assert J[:, 0] - exact(x)[:, 0] == pytest.approx(h * TIME, abs=rounding)


@pytest.mark.parametrize(("how", "power"), [(SECANT, 1.0), (PARABOLA, 2.0)])
@pytest.mark.parametrize("at", [0.0, 0.4, 1.0])
def test_error_falls_with_a_power_of_the_step(how: Difference, power: float, at: float) -> None:
    def wave(X: FloatArray) -> list[FloatArray]:
        return [np.exp(2.0 * x) for x in X]

    x, exact_slope = np.array([at]), 2.0 * math.exp(2.0 * at)
    errors = [
        abs(derivatives(wave, x, np.exp(2.0 * x), how._replace(step=h))[0].item() - exact_slope)
        for h in (0.02, 0.01)
    ]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(power, abs=0.1)


@pytest.mark.parametrize("how", [SECANT, PARABOLA])
def test_other_side_serves_where_a_run_fails(how: Difference) -> None:
    x = np.array([0.3, 0.6])
    J, found = derivatives(watched([], fails=0.3), x, quadratic(x), how)
    assert found.all()
    assert pytest.approx(exact(x), abs=2.0 * how.step if how is SECANT else 1e-8) == J


@pytest.mark.parametrize("how", [SECANT, PARABOLA])
def test_derivative_is_zero_and_not_found_where_no_run_beside_finishes(how: Difference) -> None:
    def alone(X: FloatArray) -> list[FloatArray | None]:
        return [None if x[0] != 0.3 else quadratic(x) for x in X]

    x = np.array([0.3, 0.6])
    J, found = derivatives(alone, x, quadratic(x), how)
    assert found.tolist() == [False, True]
    assert not J[:, 0].any()
    assert J[:, 1] == pytest.approx(exact(x)[:, 1], abs=2.0 * how.step)


def test_points_never_lie_so_near_that_rounding_shows() -> None:
    # Just inside a limit, where the outer side of a central difference has no room.
    for a in np.geomspace(1e-12, PARABOLA.step, 40):
        asked: list[FloatArray] = []
        x = np.array([a, 0.5])
        derivatives(watched(asked), x, quadratic(x), PARABOLA)
        assert min(abs(there[0] - a) for there in asked if there[0] != a) >= LEAST * PARABOLA.step
