"""Noise: its covariance is the one asked for."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.linalg import toeplitz

from pyrofit.data.noise import (
    FloatArray,
    autoregressive,
    draw_noise,
    lowest_density,
    moving_average,
)

POINTS = 40
KINDS: dict[str, FloatArray] = {
    "white": moving_average([], POINTS),
    "differenced balance": moving_average([-0.25, -0.2], POINTS),
    "differenced white noise": moving_average([-0.5], POINTS),
    "slow": autoregressive(0.9, POINTS),
    "alternating": autoregressive(-0.7, POINTS),
}


class Given(np.random.Generator):
    """A generator whose normal numbers are given."""

    def __init__(self, numbers: FloatArray) -> None:
        super().__init__(np.random.PCG64(0))
        self._numbers = numbers

    @property
    def standard_normal(self) -> Callable[[int], FloatArray]:  # type: ignore[override]
        return lambda size: self._numbers[:size].copy()


@pytest.mark.parametrize("r", KINDS.values(), ids=KINDS)
def test_noise_has_exactly_the_covariance_asked_for(r: FloatArray) -> None:
    # Noise is linear in the white numbers z: with e = L z its covariance is L L^T.
    L = np.column_stack([draw_noise(r, Given(z)) for z in np.eye(POINTS)])
    assert np.abs(L @ L.T - toeplitz(r)).max() < 1e-14  # measured 1.1e-15
    assert np.all(np.triu(L, 1) == 0.0)


def test_covariance_of_many_draws_is_the_one_asked_for() -> None:
    r = moving_average([-0.25, -0.2], 6)
    rng = np.random.default_rng(1)
    draws = np.array([draw_noise(r, rng) for _ in range(20000)])
    # A sample covariance of 20000 draws scatters by 0.007 to 0.01; measured 0.016 at most.
    assert np.abs(np.cov(draws.T) - toeplitz(r)).max() < 0.03
    assert np.abs(draws.mean(axis=0)).max() < 0.03


def test_draws_are_equal_for_equal_seeds_alone() -> None:
    r = autoregressive(0.9, 50)
    first, again, other = (draw_noise(r, np.random.default_rng(seed)) for seed in (3, 3, 4))
    assert np.array_equal(first, again)
    assert not np.any(first == other)


def test_white_noise_is_the_generators_own() -> None:
    white = draw_noise(moving_average([], 9), np.random.default_rng(2))
    assert np.array_equal(white, np.random.default_rng(2).standard_normal(9))
    assert np.array_equal(autoregressive(0.0, 9), moving_average([], 9))


def test_fewer_points_than_lags_keep_the_first_lags() -> None:
    assert moving_average([0.3, 0.2, 0.1], 2).tolist() == [1.0, 0.3]
    assert draw_noise(moving_average([0.3], 1), np.random.default_rng(1)).shape == (1,)


@pytest.mark.parametrize("lags", [[], [0.4], [-0.25, -0.2], [-0.12, -0.4], [0.3, 0.2, 0.1, 0.4]])
def test_lowest_density_is_that_of_a_fine_grid(lags: list[float]) -> None:
    w = np.linspace(0.0, np.pi, 10001)
    density = 1.0 + 2.0 * sum((r * np.cos(k * w) for k, r in enumerate(lags, 1)), np.zeros(w.size))
    # Steps of pi/10000 miss a minimum by less than 1/2 f'' (pi/20000)^2 < 3e-7.
    assert lowest_density(lags) == pytest.approx(density.min(), abs=3e-7)
    assert lowest_density(lags) <= density.min() + 1e-12
