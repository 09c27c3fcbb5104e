"""The scatter between repeats as a part of their noise."""

import numpy as np
import pytest
from collapses import NOISE, SAME, SCATTER, TIME, WAYS, coverage, curve, fit, noise_of, records

from pyrofit.estimate.between_repeats import USUAL, USUAL_WEIGHT, student_factor
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import NoiseModel
from pyrofit.solver.arrays import FloatArray

TRUTH = np.array([1.0, 1.0, 0.3])


def equal(repeats: int, seed: int = 3) -> FloatArray:
    """Return repeats that differ by the noise of their points alone."""
    rng = np.random.default_rng(seed)
    return curve(TRUTH) + NOISE * rng.standard_normal((repeats, TIME.size))


def test_whitening_with_modes_is_that_of_the_whole_covariance() -> None:
    rng = np.random.default_rng(2)
    U = rng.standard_normal((60, 5))
    noise = NoiseModel(np.linspace(1.0, 2.0, 60), Correlation(ar=0.6), modes=U)
    residuals = rng.standard_normal((60, 3))
    r = Correlation(ar=0.6).sequence(60)
    R = r[np.abs(np.subtract.outer(np.arange(60), np.arange(60)))]
    covariance = R * np.outer(noise.sd, noise.sd) + U @ U.T
    white = noise.whiten(residuals)
    assert white.T @ white == pytest.approx(residuals.T @ np.linalg.solve(covariance, residuals))
    assert noise.whiten(residuals[:, 0]) == pytest.approx(white[:, 0])
    assert noise.total_sd == pytest.approx(np.sqrt(np.diag(covariance)))


def test_noise_without_modes_whitens_to_the_same_bits() -> None:
    noise = NoiseModel(np.linspace(1.0, 2.0, 60), Correlation(ar=0.6))
    r = np.random.default_rng(2).standard_normal(60)
    assert np.array_equal(noise.whiten(r), noise.correlation.whiten(r / noise.sd))
    assert noise.total_sd is noise.sd


def test_equal_repeats_have_the_noise_of_their_points_only() -> None:
    for free in (False, True):
        assert all(noise.modes is None for noise in noise_of(equal(3), free))


def test_scatter_between_repeats_is_a_floor_of_its_size() -> None:
    # Amplitudes 1 - d, 1, 1 + d: the standard deviation between them is d times the curve.
    d = 0.1
    measured = equal(3) + d * np.outer([-1.0, 0.0, 1.0], curve(TRUTH))
    noises = noise_of(measured, free=False)
    plateau = (TIME > 0.35) & (TIME < 0.65)
    for noise in noises:
        between = np.sqrt(noise.total_sd**2 - NOISE**2)[plateau]
        # Half a repeat with the usual level counts beside three; it is larger here than usual.
        share = np.sum((d * curve(TRUTH)) ** 2) / np.sum(usual_changes() ** 2)
        care2 = (USUAL_WEIGHT + 2.0 * share) / (USUAL_WEIGHT + 2.0)
        size = np.sqrt((2.0 * d**2 + USUAL_WEIGHT * care2 * USUAL[0] ** 2) / (2.0 + USUAL_WEIGHT))
        expected = size * curve(TRUTH)[plateau]
        assert between == pytest.approx(expected, rel=0.15)
        # Intervals and tests have it twice: as it was seen, and in directions that were not.
        cautious = np.sqrt(noise.cautious.total_sd**2 - NOISE**2)[plateau]
        factor = student_factor(2.0 + USUAL_WEIGHT) * np.sqrt(2.0)
        assert cautious == pytest.approx(factor * expected, rel=0.15)
        assert noise.floors["repeats"] > 0.0
        assert "repeats" in noise.describe()


def test_records_on_other_times_scatter_alike() -> None:
    measured = records(3, np.random.default_rng(4))
    full = noise_of(measured, free=False)
    # Every other point of the second.
    thinned = [measured[0], measured[1, ::2], measured[2]]
    other = noise_of(thinned, free=False, times=[TIME, TIME[::2], TIME])
    assert [n.sd.size for n in other] == [120, 60, 120]
    assert np.median(full[0].total_sd) > 2.0 * NOISE
    assert other[0].total_sd == pytest.approx(full[0].total_sd, rel=0.35)
    assert other[1].total_sd == pytest.approx(full[1].total_sd[::2], rel=0.35)


def test_aligned_repeats_leave_no_scatter_where_parameters_stand_for_it() -> None:
    measured = records(3, np.random.default_rng(5))
    stands, free = (noise_of(measured, f) for f in (False, True))
    assert all(n.modes is not None for n in stands)
    for before, after in zip(stands, free, strict=True):
        assert np.median(after.total_sd) < 0.6 * np.median(before.total_sd)


def test_averaged_collapse_is_smeared_and_looks_like_missing_physics() -> None:
    measured = records(2, np.random.default_rng([1, 2, 7]))
    sd = NOISE / np.sqrt(2.0)
    mean = measured.mean(axis=0, keepdims=True)
    averaged = fit(mean, (NoiseModel(np.full(TIME.size, sd), Correlation()),))
    own = fit(measured, noise_of(measured, free=True), free=True)
    assert averaged.chi2 > 1.3
    assert own.chi2 < 1.2


def usual_changes() -> FloatArray:
    """Return the changes by the usual level, stretch and start, shape (3, 120)."""
    level, stretch, start = USUAL
    slope = np.gradient(curve(TRUTH), TIME)
    return np.array([level * curve(TRUTH), stretch * TIME * slope, start * slope])


def true_sd(scatter: FloatArray) -> FloatArray:
    """Return the standard deviation of a repeat about the curve that all share."""
    rng = np.random.default_rng(7)
    drawn = np.array([curve(TRUTH, SAME + scatter * rng.standard_normal(3)) for _ in range(1000)])
    return np.sqrt(NOISE**2 + np.mean((drawn - curve(TRUTH)) ** 2, axis=0))


@pytest.mark.parametrize(("repeats", "share"), [(2, 1.0), (3, 1.0), (8, 1.0), (2, 0.3), (3, 0.3)])
def test_noise_of_repeats_has_its_true_size(repeats: int, share: float) -> None:
    truth, ratios, misfits = true_sd(share * SCATTER), [], []
    for i in range(8):
        measured = records(repeats, np.random.default_rng([1, repeats, i]), share)
        noise = noise_of(measured, free=False)
        ratios.append(np.median(noise[0].total_sd / truth))
        pairs = zip(noise, measured, strict=True)
        misfits.append(np.mean([np.mean(n.whiten(y - curve(TRUTH)) ** 2) for n, y in pairs]))
    assert 0.77 < np.median(ratios) < 1.3
    assert 0.7 < np.median(misfits) < 1.3


@pytest.mark.slow
def test_intervals_hold_the_truth_unless_repeats_are_averaged() -> None:
    found = {way: coverage(way, 3, 60)[0] for way in WAYS}
    # 60 draws: 0.95 has a standard deviation of 0.03, the mean of three parameters one of 0.02.
    assert 0.90 <= found["nuisances"].mean() <= 0.99
    assert 0.90 <= found["floor"].mean() <= 1.0
    assert found["nuisances"].min() > 0.85
    assert found["floor"].min() > 0.80
    assert found["averaged"].max() < 0.5
