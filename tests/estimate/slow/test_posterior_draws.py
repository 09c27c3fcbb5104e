"""Sampler, convergence, discrepancy and bands, on problems whose answer is known."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from pyrofit.estimate import discrepancy, ensembles
from pyrofit.estimate.bands import band, carried, free, measured
from pyrofit.estimate.convergence import autocorrelation_times, rhat
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.discrepancy import Discrepancy, factor_of, half_time, noise_covariance
from pyrofit.estimate.ensembles import Drawn, draw
from pyrofit.estimate.noise import NoiseModel
from pyrofit.solver.arrays import FloatArray

MEAN = np.array([0.4, 0.6])
SD = np.array([[0.05, 0.0], [0.03, 0.02]])
COVARIANCE = SD @ SD.T


class Parabola:
    """-2 log likelihood |L^-1 (x - mean)|^2, as the sampler asks for it."""

    def __init__(self, mean: FloatArray) -> None:
        self.mean = mean

    def residuals_all(self, X: FloatArray) -> list[FloatArray]:
        return list(np.linalg.solve(SD, (X - self.mean).T).T)

    def finished(self, residuals: FloatArray) -> bool:
        return bool(residuals[0] < 1e3)


def drawn(mean: FloatArray = MEAN, seed: int = 3, cores: int = 1, steps: int = 400) -> Drawn:
    parabola: Any = Parabola(mean)
    return draw(parabola, np.clip(mean, 0.0, 1.0), COVARIANCE, seed, cores, steps)


def test_draws_have_mean_and_covariance_of_a_known_parabola() -> None:
    found = drawn()
    assert found.converged
    assert np.mean(found.flat, axis=0) == pytest.approx(MEAN, abs=0.005)
    assert np.cov(found.flat.T) == pytest.approx(COVARIANCE, rel=0.15)


def test_draws_stay_within_limits_and_follow_the_cut_off_distribution() -> None:
    found = drawn(np.array([0.0, 0.6]), steps=400)
    assert np.min(found.flat) >= 0.0
    # The mean of the positive half of a normal distribution is sd sqrt(2/pi).
    assert np.mean(found.flat[:, 0]) == pytest.approx(0.05 * np.sqrt(2.0 / np.pi), rel=0.08)


def test_draws_depend_on_the_seed_alone() -> None:
    one, again, two, other = (
        drawn(seed=seed, cores=cores, steps=40) for seed, cores in ((3, 1), (3, 1), (3, 2), (4, 1))
    )
    assert one.samples.tobytes() == again.samples.tobytes() == two.samples.tobytes()
    assert one.samples.tobytes() != other.samples.tobytes()


def test_short_ensembles_are_said_not_to_have_converged() -> None:
    assert not drawn(steps=20).converged


def test_sets_outside_the_limits_or_that_fail_are_impossible() -> None:
    parabola: Any = Parabola(MEAN)
    found = ensembles.log_density(parabola, np.array([[0.4, 0.6], [1.1, 0.6], [0.45, 0.6]]))
    assert found[:2].tolist() == [0.0, -np.inf]
    # x is one sd off in the first row; the second then lies 0.03 above its mean there.
    assert found[2] == pytest.approx(-0.5 * (1.0 + 1.5**2))
    parabola.finished = lambda residuals: False
    assert ensembles.log_density(parabola, MEAN[None])[0] == -np.inf


def test_rhat_tells_ensembles_apart_by_place_and_by_spread() -> None:
    rng = np.random.default_rng(0)
    alike = rng.standard_normal((4, 200, 10))
    assert rhat(alike) < 1.01
    shifted, wider = alike.copy(), alike.copy()
    shifted[0] += 1.0
    wider[0] *= 4.0
    assert rhat(shifted) > 1.05
    assert rhat(wider) > 1.05


TIME = np.linspace(0.0, 1000.0, 150)
CURVE = 1e-2 * np.exp(-(((TIME - 500.0) / 180.0) ** 2))


def test_walker_that_never_moved_makes_its_parameter_unsettled() -> None:
    samples = np.random.default_rng(4).random((2, 60, 5, 2))
    moving = autocorrelation_times(samples)
    samples[1, :, 3, 0] = 0.5
    times = autocorrelation_times(samples)
    assert times[0] == 60.0
    assert times[1] == moving[1] < 10.0


def noise(sd: float) -> NoiseModel:
    return NoiseModel(np.full(TIME.size, sd), Correlation(ar=0.5))


def test_noise_covariance_is_that_of_the_stated_correlation() -> None:
    lag = np.abs(np.subtract.outer(np.arange(TIME.size), np.arange(TIME.size)))
    assert noise_covariance(noise(2.0)) == pytest.approx(4.0 * 0.5**lag, abs=1e-10)


def test_discrepancy_has_the_variance_of_its_parts() -> None:
    D = Discrepancy(0.1, 0.0, 0.0, 0.2).covariance(TIME, CURVE)
    assert np.diag(D) == pytest.approx(0.01 * (CURVE - CURVE[0]) ** 2)
    D = Discrepancy(0.0, 0.02, 0.0, 0.2).covariance(TIME, CURVE)
    assert np.diag(D) == pytest.approx(4e-4 * (TIME * np.gradient(CURVE, TIME)) ** 2)
    D = Discrepancy(0.0, 0.0, 0.1, 0.2).covariance(TIME, CURVE)
    apart = 0.2 * half_time(TIME, CURVE)
    expected = 0.01 * np.ptp(CURVE) ** 2 * np.exp(-0.5 * (TIME / apart) ** 2)
    assert D[0] == pytest.approx(expected)


def size(of: Discrepancy) -> float:
    """Return the root mean square of a discrepancy over the range of the curve."""
    variance = np.diag(of.covariance(TIME, CURVE))
    return float(np.sqrt(np.mean(variance)) / np.ptp(CURVE))


@pytest.mark.parametrize("level", [0.0, 0.1, 0.3])
def test_estimated_discrepancy_is_about_what_was_drawn(level: float) -> None:
    rng = np.random.default_rng(5)
    truth = Discrepancy(level, 0.0, 0.0, 0.4)
    sizes = []
    for _ in range(3):
        lacking = free(truth.covariance(TIME, CURVE), 1, rng)[0] if level else 0.0
        e = factor_of(noise_covariance(noise(1e-4))) @ rng.standard_normal(TIME.size)
        sizes.append(size(estimated(CURVE + lacking + e, 1e-4)))
    if level:
        assert np.median(sizes) == pytest.approx(size(truth), rel=0.5)
    else:
        assert np.median(sizes) < 0.02  # the noise of a point is 0.01


def estimated(value: FloatArray, sd: float) -> Discrepancy:
    """Return the discrepancy of a series about CURVE, whose size is the one parameter."""
    target = SimpleNamespace(value=value, time_s=TIME)
    cost = SimpleNamespace(terms=[(1.0, SimpleNamespace(target=target))])
    likelihood: Any = SimpleNamespace(
        problem=SimpleNamespace(cost=cost, span=np.ones(1)),
        noise=(noise(sd),),
        prior=SimpleNamespace(slopes=lambda span: np.zeros((0, 1))),
        split=lambda stacked: [stacked],
    )
    slopes = CURVE[:, None] * 1.0
    return discrepancy.estimated(likelihood, np.array([0.5]), slopes, CURVE)[0]


def test_carried_errors_scale_move_and_lift_a_curve() -> None:
    curves = np.tile(CURVE, (2000, 1))
    rng = np.random.default_rng(2)
    level = Discrepancy(0.05, 0.0, 0.0, 0.5).carried_to(TIME, curves, rng)
    inside = 0.1 * CURVE.max() < CURVE
    assert np.std(level, axis=0)[inside] == pytest.approx(0.05 * CURVE[inside], rel=0.1)
    moved = Discrepancy(0.0, 0.05, 0.0, 50.0).carried_to(TIME, curves, rng)
    assert moved.max() <= CURVE.max()
    assert moved.min() >= CURVE.min()
    # The peak at 500 s moves by 5 % of that.
    assert np.std(TIME[np.argmax(moved, axis=1)]) == pytest.approx(25.0, rel=0.1)
    lifted = Discrepancy(0.0, 0.0, 0.02, 0.5).carried_to(TIME, curves, rng)
    assert np.std(lifted, axis=0) == pytest.approx(0.02 * np.ptp(CURVE), rel=0.1)


def test_drawn_discrepancy_of_a_measured_series_has_the_exact_mean_and_sd() -> None:
    rng = np.random.default_rng(1)
    D = Discrepancy(0.05, 0.0, 0.02, 0.2).covariance(TIME, CURVE)
    residual = 3e-4 * np.sin(TIME / 90.0)
    N = noise_covariance(noise(2e-4))
    found = measured(D, noise(2e-4), np.tile(residual, (4000, 1)), rng)
    gain = D @ np.linalg.inv(D + N)
    sd = np.sqrt(np.diag(D - gain @ D))
    assert np.mean(found, axis=0) == pytest.approx(gain @ residual, abs=0.08 * np.max(sd))
    assert np.std(found, axis=0) == pytest.approx(sd, rel=0.08)


def test_bands_are_quantiles_and_carried_sizes_are_averaged_in_squares() -> None:
    assert band(np.arange(41.0)[:, None])[:, 0] == pytest.approx([1.0, 20.0, 39.0])
    both = carried([Discrepancy(0.03, 0.0, 0.01, 0.1), Discrepancy(0.04, 0.02, 0.01, 0.4)])
    assert both.level == pytest.approx(np.sqrt((0.03**2 + 0.04**2) / 2.0))
    assert both.offset == pytest.approx(0.01)
    assert both.lasting == pytest.approx(0.2)
