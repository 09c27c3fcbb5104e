"""Intervals and verdicts on models whose chi-square is known in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from line_model import LINE, TIME, WHITE, N, by_name, likelihood, line
from scipy.optimize import least_squares

from pyrofit.estimate.derivatives import SECANT
from pyrofit.estimate.identify import identify, verdict
from pyrofit.estimate.likelihood import FAILED, fit
from pyrofit.estimate.profile import Interval, Profile
from pyrofit.results.goodness import LEVEL
from pyrofit.solver.arrays import FloatArray


def test_interval_of_a_straight_line_is_that_of_linear_regression() -> None:
    found = identify(line(), [np.array([0.2, 0.9])])
    sd = np.sqrt(np.diag(np.linalg.inv(LINE.T @ LINE / 0.1**2))) / [2.0, 4.0]
    for estimate, true, exact in zip(found.estimates, (0.5, 0.5), sd, strict=True):
        # A descent ends within 1e-4 of chi-square, 0.01 standard deviations.
        assert estimate.x == pytest.approx(true, abs=0.01 * exact)
        assert estimate.sd == pytest.approx(exact, rel=1e-3)  # the limits as a prior: 2e-4
        assert estimate.noise.width == pytest.approx(2 * 1.96 * exact, rel=1e-3)
        assert estimate.method == "linear"
        assert estimate.verdict == "determined"
    exact_correlation = -np.sqrt(3.0) / 2.0  # of offset and slope on [0, 1]
    assert found.correlation[0, 1] == pytest.approx(exact_correlation, abs=0.01)
    assert found.posterior.dispersion == pytest.approx(1.0, abs=1e-6)


def test_noise_understated_twice_doubles_the_interval_and_not_that_of_noise_alone() -> None:
    right = identify(line(), [np.array([0.5, 0.5])])
    value = line().problem.cost.terms[0][1].target.value
    half = likelihood(lambda x: LINE @ x, value, 0.05, ((0.0, 2.0), (0.0, 4.0)))
    found = identify(half, [np.array([0.5, 0.5])])
    assert found.posterior.dispersion == pytest.approx(4.0, rel=1e-5)
    assert found.estimates[0].interval.width == pytest.approx(
        right.estimates[0].interval.width, rel=1e-3
    )
    assert found.estimates[0].noise.width == pytest.approx(
        0.5 * right.estimates[0].noise.width, rel=1e-3
    )


def test_parameter_without_effect_is_undetermined_and_open_at_both_limits() -> None:
    value = 1.0 + 0.1 * WHITE
    posed = likelihood(lambda x: x[0] + 0.0 * TIME, value, 0.1, ((0.0, 2.0), (0.0, 1.0)))
    found = by_name(identify(posed, [np.array([0.3, 0.4])]))
    assert found["a"].verdict == "determined"
    assert found["b"].interval == Interval(0.0, 1.0, True, True)
    assert found["b"].verdict == "undetermined"
    assert found["b"].method == "profile"


def test_estimate_that_the_data_push_out_of_its_limits_is_at_its_bound() -> None:
    # The mean is 1 + 0.1 * 0.04...; the upper limit lies 2 sd of the mean below it.
    mean = float(np.mean(1.0 + 0.1 * WHITE))
    sd = 0.1 / np.sqrt(N)
    upper = mean - 2.0 * sd
    posed = likelihood(lambda x: x[0] + 0.0 * TIME, 1.0 + 0.1 * WHITE, 0.1, ((upper - 1.0, upper),))
    (estimate,) = identify(posed, [np.array([0.5])]).estimates
    assert estimate.x == 1.0
    assert estimate.bound == "upper"
    assert estimate.verdict == "at its upper limit"
    assert estimate.interval.high_open
    # (d + 2 sd)^2 - (2 sd)^2 = 3.84 sd^2 at d = (sqrt(7.84) - 2) sd
    assert 1.0 - estimate.noise.low == pytest.approx((np.sqrt(7.8416) - 2.0) * sd, rel=0.02)


@pytest.mark.parametrize(
    ("slope", "limits", "verdict_of_a"),
    [
        (2.0, (0.0, 1.97), "weakly determined"),
        (2.0, (0.0, 4.0), "determined"),
        (0.03, (0.09, 2.0), "weakly determined"),
        (-0.03, (0.0, 2.0), "determined"),  # no number goes beyond 0
    ],
)
def test_value_that_rests_on_a_limit_reached_is_weakly_determined(
    slope: float, limits: tuple[float, float], verdict_of_a: str
) -> None:
    value = LINE @ [1.0, slope] + 0.1 * WHITE
    posed = likelihood(lambda x: LINE @ x, value, 0.1, ((0.0, 2.0), limits))
    found = by_name(identify(posed, [np.array([0.5, 0.5])]))
    assert found["a"].interval.width < 0.03
    assert found["a"].verdict == verdict_of_a


def test_verdict_is_that_on_the_likeliest_values_where_least_squares_miss_less() -> None:
    """Lasting errors weigh little: the likeliest curve follows the waves, and is far off."""
    waves = 0.05 * np.sin(60.0 * TIME)
    value = 0.4 * TIME + waves + 0.01 * WHITE
    posed = likelihood(lambda x: x[0] * (TIME + waves), value, 0.01, ((0.0, 2.0),))
    noise = replace(posed.noise[0], modes=TIME[:, None])
    found = identify(replace(posed, noise=(noise,)), [np.array([0.5])])
    (estimate,), (signal,) = found.estimates, found.goodness.signals
    assert estimate.verdict == "apparent value"
    assert 2.0 * estimate.x == pytest.approx(0.4, abs=0.02)  # of least squares
    assert found.goodness.p >= LEVEL
    assert not found.goodness.describes
    assert signal.far_off
    assert signal.misses


def test_profile_of_a_square_is_the_exact_one() -> None:
    # y = a^2, a in [0, 1]: chi2 rises by n (a^2 - m)^2 / sd^2, m the mean. sd as large as this
    # makes the interval wide and lopsided.
    sd, m = 1.0, 0.25
    value = m + sd * (WHITE - WHITE.mean()) * np.sqrt((N - 1) / N) / WHITE.std()
    posed = likelihood(lambda x: x[0] ** 2 + 0.0 * TIME, value, sd, ((0.0, 1.0),))
    (estimate,) = identify(posed, [np.array([0.3])]).estimates
    half = 1.96 * sd / np.sqrt(N)
    assert estimate.method == "profile"
    assert estimate.x == pytest.approx(0.5, abs=1e-4)
    assert estimate.noise.low == pytest.approx(np.sqrt(m - half), abs=2e-3)
    assert estimate.noise.high == pytest.approx(np.sqrt(m + half), abs=2e-3)


def test_profile_refits_the_other_parameters() -> None:
    # Only the sum of both matters: alone each is anything that the other can make up for.
    posed = likelihood(
        lambda x: x[0] + x[1] + 0.0 * TIME, 1.0 + 0.01 * WHITE, 0.01, ((0.0, 2.0), (0.0, 2.0))
    )
    found = identify(posed, [np.array([0.2, 0.2])])
    mean = 1.0 + 0.01 * WHITE.mean()
    for estimate in found.estimates:
        assert estimate.interval.low_open
        assert estimate.interval.high == pytest.approx(0.5 * mean, abs=2e-3)
        assert estimate.verdict == "weakly determined"  # 0.4997 wide, 0.5 is the bound
    assert found.correlation[0, 1] < -0.99
    values, directions = found.modes()
    assert values[0] == pytest.approx(np.sqrt(2.0 * N) * 2.0 / 0.01, rel=1e-6)
    assert abs(directions[0, 0]) == pytest.approx(np.sqrt(0.5), rel=1e-6)
    assert values[1] < 1e-6 * values[0]


def test_lower_chi_square_found_by_a_profile_becomes_the_optimum() -> None:
    # Two minima, at 0.2 and the lower one at 0.8, with a barrier of 1.6 between them.
    def formula(x: FloatArray) -> FloatArray:
        return np.full(N, 5.0 * ((x[0] - 0.2) * (x[0] - 0.8)) + 0.1 * (0.8 - x[0]))

    posed = likelihood(formula, np.zeros(N), 5.0, ((0.0, 1.0),))
    start = posed.descend(np.array([0.1]))
    found = identify(posed, [np.array([0.1])])
    assert found.optimum.chi2 <= start.chi2


def test_descent_agrees_with_scipys_within_the_limits() -> None:
    def formula(x: FloatArray) -> FloatArray:
        return x[0] * np.exp(-x[1] * TIME) + x[2] * TIME

    value = formula(np.array([1.5, 3.0, -0.2])) + 0.02 * WHITE
    posed = likelihood(formula, value, 0.02, ((0.0, 2.0), (0.0, 5.0), (0.0, 1.0)))
    start = np.array([0.2, 0.9, 0.8])
    ours = posed.descend(start)
    theirs = least_squares(posed.residuals, start, bounds=(0.0, 1.0), xtol=1e-12, ftol=1e-12)
    assert ours.x[2] == 0.0
    assert ours.chi2 <= 2.0 * theirs.cost + 1e-3
    assert ours.x == pytest.approx(theirs.x, abs=1e-3)


@pytest.mark.parametrize("at", [0.0, 0.5, 1.0])
def test_slopes_are_those_of_secants_inside_and_at_the_limits(at: float) -> None:
    posed = likelihood(lambda x: x[0] ** 2 * TIME, TIME, 1.0, ((0.0, 2.0),))
    # y = (2 u)^2 t: dy/du = 8 u t, and half of the second derivative is 4 t
    h = SECANT.step if at < 0.5 else -SECANT.step
    expected = (8.0 * at + 4.0 * h) * TIME
    assert posed.slopes(np.array([at]))[:, 0] == pytest.approx(expected, abs=1e-9)


def test_failed_run_is_worse_than_any_and_a_descent_ends_before_it() -> None:
    posed = likelihood(lambda x: None if x[0] > 1.0 else x[0] * TIME, TIME, 1.0, ((0.0, 2.0),))
    assert posed.chi2(np.array([0.9])) == N * FAILED**2
    assert not posed.finished(posed.residuals(np.array([0.9])))
    assert posed.slopes(np.array([0.9])).tolist() == [[0.0]] * N
    assert posed.descend(np.array([0.2])).x[0] == pytest.approx(0.5, abs=2e-3)


def test_fit_takes_the_best_of_the_starts() -> None:
    def formula(x: FloatArray) -> FloatArray:
        return np.sin(12.0 * x[0]) + 0.3 * x[0] + 0.0 * TIME

    posed = likelihood(formula, np.full(N, 1.25), 0.1, ((0.0, 1.0),))
    best = fit(posed, [np.array([0.1]), np.array([0.6]), np.array([0.605])])
    assert best.x[0] == pytest.approx(0.657, abs=2e-3)


def test_profile_interpolates_the_root_of_the_rise() -> None:
    x = np.array([0.1, 0.4, 0.5, 0.6, 0.7])
    profile = Profile(x, (10.0 * (x - 0.5)) ** 2)
    assert profile.interval(1.0) == Interval(pytest.approx(0.304), pytest.approx(0.696))
    wide = profile.interval(4.0)
    assert wide.low == pytest.approx(0.108)
    assert (wide.high, wide.high_open) == (1.0, True)


def test_verdict_at_its_limits() -> None:
    assert verdict(0.2, "") == "determined"
    assert verdict(0.21, "") == "weakly determined"
    assert verdict(0.51, "lower") == "undetermined, at its lower limit"
