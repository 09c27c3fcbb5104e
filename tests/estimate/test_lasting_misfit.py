"""Windows of a lasting misfit are found below a drift that whitening would hide."""

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.lasting_misfit import DRAWS, largest
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.scan import highest
from pyrofit.solver.arrays import FloatArray

POINTS = 150


def noise(points: int = POINTS) -> NoiseModel:
    """Return white noise of sd 1 with a drift of sd 3 over 10 % of the record."""
    knots, at = np.linspace(0.0, 1.0, 41), np.linspace(0.0, 1.0, points)
    factor = np.linalg.cholesky(np.exp(-np.abs(np.subtract.outer(knots, knots)) / 0.1))
    drift = 3.0 * np.column_stack([np.interp(at, knots, column) for column in factor.T])
    return NoiseModel(np.ones(points), Correlation(), modes=drift)


def of_repeats() -> NoiseModel:
    """Return the noise of smooth records whose repeats differ in level and start."""
    knots, at = np.linspace(0.0, 1.0, 41), np.linspace(0.0, 1.0, POINTS)
    level = 1.0 - np.exp(-knots / 0.3)
    seen = 3.0 * np.column_stack([level, knots * np.exp(1.0 - knots / 0.3) / 0.3])
    size = np.sqrt(np.sum(seen**2, axis=1))
    factor = np.linalg.cholesky(np.exp(-np.abs(np.subtract.outer(knots, knots)) / 0.05))
    both = np.column_stack([np.sqrt(0.9) * seen, np.sqrt(0.1) * size[:, None] * factor])
    modes = np.column_stack([np.interp(at, knots, column) for column in both.T])
    return NoiseModel(np.full(POINTS, 0.03), Correlation(), modes=modes)


def likelihood(*noises: NoiseModel) -> Any:
    at = np.cumsum([0, *(one.sd.size for one in noises)])
    ranges = list(pairwise(at.tolist()))
    return SimpleNamespace(noise=noises, split=lambda rows: [rows[a:b] for a, b in ranges])


def spanned(*columns: FloatArray) -> FloatArray:
    return np.linalg.qr(np.column_stack(columns))[0]


def p_of(shown: float, drawn: FloatArray) -> float:
    return float(1 + np.count_nonzero(drawn >= shown)) / (1 + drawn.size)


def disturbed(size: float, seed: int) -> FloatArray:
    """Return noise with an error of some standard deviations over the second third, without sd."""
    own, rng = noise(), np.random.default_rng(seed)
    assert own.modes is not None
    e = rng.standard_normal(POINTS) + own.modes @ rng.standard_normal(41)
    e[50:100] += size * own.total_sd[50:100]
    return e


def test_draws_of_noise_have_even_probabilities() -> None:
    own = noise()
    Q = spanned(own.whiten(np.linspace(-1.0, 1.0, POINTS)))
    found = []
    for seed in range(100):
        w = own.whiten(disturbed(0.0, seed))
        shown, drawn = largest(likelihood(own), [w - Q @ (Q.T @ w)], Q)
        found.append(p_of(float(shown[0]), drawn[:, 0]))
    # Of 100 even probabilities, 2 to 9 are below 0.05 with 95 %.
    assert 1 <= sum(p < 0.05 for p in found) <= 10
    assert np.mean(found) == pytest.approx(0.5, abs=3.0 / np.sqrt(12.0 * 100.0))


def test_lasting_misfit_is_found_where_windows_of_whitened_residuals_hardly_show_it() -> None:
    own = noise()
    Q = spanned(own.whiten(np.linspace(-1.0, 1.0, POINTS)))
    draws = np.random.default_rng(1).standard_normal((POINTS, DRAWS))
    of_whitened = np.sort(highest(draws - Q @ (Q.T @ draws)))
    new = old = 0
    for seed in range(40):
        w = own.whiten(disturbed(3.0, seed))
        w = w - Q @ (Q.T @ w)
        shown, drawn = largest(likelihood(own), [w], Q)
        new += p_of(float(shown[0]), drawn[:, 0]) < 0.01
        old += bool(highest(w[:, None])[0] > of_whitened[-DRAWS // 100])
    assert new >= 38
    assert old < new


def test_smooth_misfit_is_found_below_points_that_hardly_scatter() -> None:
    # Least squares of a step only see that the series does not jump: they find 3 of 20.
    own, at = of_repeats(), np.linspace(0.0, 1.0, POINTS)
    assert own.modes is not None
    Q = spanned(own.whiten(at))
    misfit = 15.0 * np.interp(at, knots := np.linspace(0.0, 1.0, 41), np.sin(np.pi * knots) ** 2)
    found = 0
    for seed in range(20):
        rng = np.random.default_rng(seed)
        lasting = own.modes @ rng.standard_normal(own.modes.shape[1])
        w = own.whiten(misfit + lasting + own.sd * rng.standard_normal(POINTS))
        shown, drawn = largest(likelihood(own), [w - Q @ (Q.T @ w)], Q)
        found += p_of(float(shown[0]), drawn[:, 0]) < 0.01
    assert found >= 19


def test_each_signal_has_its_own_statistic_and_long_ones_have_bins() -> None:
    first, second = noise(), noise(700)
    w = [np.zeros(POINTS), np.zeros(700)]
    Q = spanned(np.ones(POINTS + 700))
    at = np.zeros(700)
    at[219:438] = second.total_sd[219:438]  # bins 40 to 80
    w[1] = 6.0 * second.whiten(at) / np.linalg.norm(second.whiten(at))
    shown, drawn = largest(likelihood(first, second), w, Q)
    assert drawn.shape == (DRAWS, 2)
    assert p_of(float(shown[1]), drawn[:, 1]) < 0.01
    assert shown[0] <= 0.0
    again = largest(likelihood(first, second), w, Q)
    assert np.array_equal(shown, again[0])
    assert np.array_equal(drawn, again[1])


def test_window_that_the_parameters_absorb_tells_nothing() -> None:
    own = NoiseModel(np.ones(3), Correlation())
    shown, drawn = largest(likelihood(own), [np.zeros(3)], np.eye(3))
    assert shown.tolist() == [0.0 - np.sqrt(2.0 * np.log(1.0))]
    assert np.all(drawn == 0.0)
