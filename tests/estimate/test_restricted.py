"""The restricted likelihood, against matrices written out in full."""

import numpy as np
import pytest
from scipy.linalg import toeplitz

from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.restricted import Restricted

CORRELATIONS = [
    Correlation(),
    Correlation(lags=(-0.4,)),
    Correlation(lags=(0.3, -0.2)),
    Correlation(lags=(-0.104, -0.346)),
    Correlation(ar=0.7),
    Correlation(ar=-0.4),
    Correlation(ar=0.999),
]


@pytest.mark.parametrize("known", [True, False], ids=["size known", "size unknown"])
@pytest.mark.parametrize("correlation", CORRELATIONS, ids=lambda c: c.describe())
@pytest.mark.parametrize("points", [9, 40, 41])
def test_restricted_likelihood_is_that_of_the_whole_matrices(
    points: int, correlation: Correlation, known: bool
) -> None:
    rng = np.random.default_rng(points)
    X, y = rng.standard_normal((points, 4)), 600.0 + rng.standard_normal(points)
    R = toeplitz(correlation.sequence(points))
    inverse = np.linalg.inv(R)
    curve = X.T @ inverse @ X
    P = inverse - inverse @ X @ np.linalg.solve(curve, X.T @ inverse)
    squares, rest = y @ P @ y, points - 4
    exact = np.linalg.slogdet(R)[1] + np.linalg.slogdet(curve)[1]
    exact += squares if known else rest * np.log(squares / rest)
    assert Restricted(X, y, known)(correlation) == pytest.approx(exact, rel=1e-9)


def test_series_on_its_curve_has_a_likelihood() -> None:
    X = np.random.default_rng(1).standard_normal((30, 3))
    found = Restricted(X, X @ np.ones(3), known=False)
    assert all(np.isfinite(found(correlation)) for correlation in CORRELATIONS)


@pytest.mark.parametrize("known", [True, False], ids=["size known", "size unknown"])
@pytest.mark.parametrize("points", [12, 40, 300])
def test_bound_is_below_two_lags_and_near_them(points: int, known: bool) -> None:
    rng = np.random.default_rng(points)
    at = np.linspace(-1.0, 1.0, points)
    X, white = np.vander(at, 4), rng.standard_normal(points)
    for y in (white, white + np.roll(white, 1), np.cumsum(white), np.diff(white, append=0.0)):
        likelihood = Restricted(X, y, known)
        for lags in ((0.0, 0.0), (-0.4, 0.0), (0.45, 0.0), (0.5, 0.2), (-0.1, -0.3), (0.1, 0.4)):
            correlation = Correlation(lags=lags)
            log_det, _, squares = likelihood.parts(correlation)
            exact = log_det + (squares if known else points * np.log(squares / points))
            bound = likelihood.bound(correlation)
            assert bound <= exact + 1e-9 * abs(exact)
            # What is lost is a share of the sum of squares, and less than one in twenty.
            assert exact - bound <= 0.05 * (squares if known else points)


def test_bound_without_correlation_is_exact() -> None:
    rng = np.random.default_rng(3)
    likelihood = Restricted(np.vander(np.linspace(0.0, 1.0, 50), 4), rng.standard_normal(50), True)
    squares = likelihood.parts(Correlation())[2]
    assert likelihood.bound(Correlation()) == pytest.approx(squares, rel=1e-12)
