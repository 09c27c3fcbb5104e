"""The least value of a quadratic function within limits, against scipy."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from pyrofit.estimate.quadratic import least_within


@pytest.mark.parametrize("seed", range(30))
def test_least_squares_within_limits_are_those_of_scipy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 12))
    a, b = rng.standard_normal((n + 3, n)) * np.exp(rng.normal(size=n)), rng.normal(size=n + 3)
    low, high = -rng.uniform(0.0, 0.3, n), rng.uniform(1e-3, 0.3, n)
    low[rng.random(n) < 0.2] = 0.0
    x = least_within(a.T @ a, -a.T @ b, low, high)
    best = lsq_linear(a, b, (low, high), method="bvls", tol=1e-14).x
    assert np.all((x >= low) & (x <= high))
    assert np.sum((a @ x - b) ** 2) <= np.sum((a @ best - b) ** 2) * (1.0 + 1e-10)


def test_limits_that_meet_hold_a_number() -> None:
    x = least_within(np.eye(2), -np.ones(2), np.zeros(2), np.array([0.0, 5.0]))
    assert x.tolist() == [0.0, 1.0]


def test_square_that_is_not_positive_definite_is_an_error() -> None:
    square = np.array([[1.0, 2.0], [2.0, 1.0]])
    with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
        least_within(square, np.ones(2), -np.ones(2), np.ones(2))
    square[1, 1] = np.nan
    with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
        least_within(square, np.ones(2), -np.ones(2), np.ones(2))


def test_nothing_to_find_is_no_error() -> None:
    none = np.zeros(0)
    assert least_within(np.zeros((0, 0)), none, none, none).size == 0
