"""Covariance, dispersion and limits on linear models, whose answers are known."""

import numpy as np
import pytest
from scipy.optimize import brentq

from pyrofit.estimate.posterior import (
    UNIFORM,
    Posterior,
    covariance,
    curvature,
    freedom,
    interval,
    limit_of,
)
from pyrofit.numerics import linear

RNG = np.random.default_rng(4)
J = RNG.standard_normal((80, 3)) * [30.0, 4.0, 0.3]
K = np.array([[0.0, 25.0, 0.0], [0.0, 0.0, 8.0]])
INSIDE = np.array([0.4, 0.5, 0.6])


def with_chi2(size: float) -> Posterior:
    """Return a posterior with two known values whose channels have a given chi-square."""
    residuals = RNG.standard_normal(len(J))
    residuals *= np.sqrt(size / (residuals @ residuals))
    return Posterior(INSIDE, residuals, np.vstack([J, K]))


def test_limits_count_as_a_uniform_distribution() -> None:
    drawn = RNG.uniform(size=200_000)
    assert covariance(np.zeros((5, 2))) == pytest.approx(np.eye(2) / UNIFORM)
    assert float(np.var(drawn)) == pytest.approx(1.0 / UNIFORM, rel=0.01)


def test_covariance_is_that_of_a_normal_posterior_with_wider_noise() -> None:
    found = with_chi2(400.0)
    s2 = found.dispersion
    assert s2 > 4.0
    exact = np.linalg.inv(J.T @ J / s2 + K.T @ K + 12.0 * np.eye(3))
    assert found.covariance() == pytest.approx(exact, rel=1e-9)
    assert found.covariance([0, 2]) == pytest.approx(
        np.linalg.inv(np.linalg.inv(exact)[np.ix_([0, 2], [0, 2])]), rel=1e-9
    )


def test_misfit_never_widens_a_known_value_beyond_its_standard_deviation() -> None:
    sd = [np.sqrt(with_chi2(size).covariance()[1, 1]) for size in (80.0, 1e3, 1e5, 1e9)]
    assert sd == sorted(sd)
    assert sd[-1] < 1.0 / 25.0
    assert sd[-1] == pytest.approx((25.0**2 + UNIFORM) ** -0.5, rel=1e-3)


def test_without_misfit_nothing_is_widened() -> None:
    assert with_chi2(20.0).dispersion == 1.0
    stacked = np.vstack([J, K])
    assert np.array_equal(curvature(stacked, 1.0, 2), linear.gram(stacked) + 12.0 * np.eye(3))


def test_degrees_of_freedom_are_the_mean_of_chi_square_of_a_regression() -> None:
    # The limits (1/12) and known values tell nothing beside data this good.
    sharp = 1e3 * J
    white = RNG.standard_normal((len(J), 4000))
    left = white - sharp @ np.linalg.lstsq(sharp, white, rcond=None)[0]
    mean = float(np.mean(np.sum(left**2, axis=0)))
    assert freedom(sharp, INSIDE) == pytest.approx(77.0, abs=1e-3)
    assert mean == pytest.approx(77.0, abs=4.0 * np.sqrt(2.0 * 77.0 / 4000.0))


def test_parameter_uses_up_as_much_freedom_as_the_data_determine_of_it() -> None:
    # One column of norm s uses s^2 / (s^2 + 12): a half at s^2 = 12, by the formula of ridge
    # regression (Hastie, Tibshirani, Friedman 2009, eq. 3.50).
    column = np.ones((100, 1)) / 10.0
    assert freedom(np.sqrt(12.0) * column, INSIDE[:1]) == pytest.approx(99.5)
    assert freedom(0.0 * column, INSIDE[:1]) == pytest.approx(100.0)
    known = np.vstack([np.sqrt(12.0) * column, [[np.sqrt(12.0)]]])
    assert freedom(known, INSIDE[:1], known=1) == pytest.approx(100.0 - 1.0 / 3.0)


def test_parameter_at_a_limit_uses_up_no_freedom() -> None:
    assert freedom(1e3 * J, np.array([0.004, 0.5, 1.0])) == pytest.approx(79.0, abs=1e-3)


@pytest.mark.parametrize(
    ("x", "limit"),
    [
        (0.0, "lower"),
        (0.005, "lower"),
        (0.00501, ""),
        (0.99499, ""),
        (0.995, "upper"),
        (1.0, "upper"),
    ],
)
def test_one_half_percent_from_a_limit_is_at_it(x: float, limit: str) -> None:
    assert limit_of(x) == limit


def test_interval_holds_95_percent_of_a_normal_distribution_and_ends_at_limits() -> None:
    low, high = interval(0.5, 0.1)
    draws = 0.5 + 0.1 * RNG.standard_normal(100_000)
    assert np.mean((draws > low) & (draws < high)) == pytest.approx(0.95, abs=0.003)
    assert interval(0.02, 0.1) == (0.0, pytest.approx(0.216))
    assert interval(2.0, 1.0, 1.0, 3.0) == (1.0, 3.0)
    # chi-square rises by 3.84 at the ends of the interval.
    end = brentq(lambda x: ((x - 0.5) / 0.1) ** 2 - 1.96**2, 0.5, 1.0)
    assert high == pytest.approx(end)
