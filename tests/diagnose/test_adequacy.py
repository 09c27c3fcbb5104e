"""Where a model fails: how often noise alone sounds the alarm, and what a planted misfit shows."""

from dataclasses import asdict, replace

import linear
import numpy as np
import pytest

from pyrofit.diagnose.base.adequacy import LackOfFit, lack_of_fit
from pyrofit.diagnose.search.refit import look_at
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.projection import project, projector
from pyrofit.estimate.scan import Stretch, windows_of
from pyrofit.solver.arrays import FloatArray

COLUMNS = linear.random_columns(2, "k_T", "c_T", "heater_ramp", "back_loss", size=30.0)
EFFECTS = ("k_T", "c_T", "heater_ramp")
DRAWS = 3000


def directions_of(trial: linear.FittedModel) -> list[FloatArray]:
    return [look.directions for look in look_at(trial, EFFECTS)]


@pytest.fixture(scope="module")
def trial() -> linear.FittedModel:
    return linear.fit(COLUMNS, np.random.default_rng(1).standard_normal(linear.TOTAL))


@pytest.fixture(scope="module")
def critical(trial: linear.FittedModel) -> LackOfFit:
    return lack_of_fit(trial.model, trial.fit, directions_of(trial), np.random.default_rng(2))


@pytest.fixture(scope="module")
def left(trial: linear.FittedModel) -> FloatArray:
    """What fits to draws of noise leave, shape (DRAWS, TOTAL)."""
    noise = np.random.default_rng(3).standard_normal((linear.TOTAL, DRAWS))
    return project(projector(trial.fit), noise).T


def alarms(left: FloatArray, critical: float) -> int:
    """Count the draws of which a channel has a window."""
    return sum(any(windows_of(part, critical) for part in np.split(draw, 4)) for draw in left)


# Expected 30 of 3000; the critical value is itself drawn (sd 9), the count as well (sd 5).
FEWEST, MOST = 8, 60


def test_scan_finds_windows_in_noise_at_its_level_and_not_oftener_or_rarer(
    left: FloatArray, critical: LackOfFit
) -> None:
    assert FEWEST <= alarms(left, critical.scan_critical) <= MOST
    # Another critical value would show: a fifth of a standard deviation is too much either way.
    assert alarms(left, critical.scan_critical - 0.4) > MOST
    assert alarms(left, critical.scan_critical + 0.5) < FEWEST


def test_scores_of_noise_exceed_their_critical_value_at_its_level(
    trial: linear.FittedModel, left: FloatArray, critical: LackOfFit
) -> None:
    looks = look_at(trial, EFFECTS)
    scores = np.array([max(look.score(draw) for look in looks) for draw in left])
    assert FEWEST <= np.sum(scores > critical.score_critical) <= MOST
    # One score alone would exceed 2.33 as often: the largest of several needs more.
    assert critical.score_critical > 2.5


def test_chi_square_of_noise_exceeds_its_critical_value_at_its_level(
    left: FloatArray, critical: LackOfFit
) -> None:
    count = int(np.sum(np.sum(left**2, axis=1) > critical.chi2_critical))
    assert abs(count - Settings().false_alarm_level * DRAWS) < 4.0 * np.sqrt(
        Settings().false_alarm_level * DRAWS
    )


def test_alarm_is_the_same_for_the_same_generator(
    trial: linear.FittedModel, critical: LackOfFit
) -> None:
    again = lack_of_fit(trial.model, trial.fit, directions_of(trial), np.random.default_rng(2))
    assert asdict(again) == asdict(critical)
    other = lack_of_fit(trial.model, trial.fit, directions_of(trial), np.random.default_rng(4))
    assert other.scan_critical != critical.scan_critical


def test_noise_is_adequate_and_passes(critical: LackOfFit) -> None:
    assert critical.adequate
    assert critical.passes
    assert not replace(critical, score=critical.score_critical + 0.1).passes
    assert replace(critical, score=critical.score_critical + 0.1).adequate
    assert not replace(critical, chi2=critical.chi2_critical + 0.1).adequate
    assert not replace(critical, windows=(Stretch(0, 1, 2, 9.0, 1),)).adequate


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("start", "end"), [(0, 16), (80, 112), (195, 200)])
def test_planted_window_is_found_at_its_place_and_sign(start: int, end: int, sign: int) -> None:
    w = np.random.default_rng(5).standard_normal(200)
    w[start:end] += sign * 4.0
    (found,) = windows_of(w, 2.0, channel=3)
    assert abs(found.start - start) <= 3
    assert abs(found.end - end) <= 3
    assert found.sign == sign
    assert found.channel == 3
    assert windows_of(w - w, 2.0) == []


def test_statistic_is_that_of_the_formula() -> None:
    w = np.zeros(200)
    w[80:112] = 2.0
    (found,) = windows_of(w, 2.0)
    assert (found.start, found.end) == (80, 112)
    expected = 64.0 / np.sqrt(32.0) - np.sqrt(2.0 * np.log(200.0 / 32.0))
    assert found.statistic == pytest.approx(expected, rel=1e-12)


def test_windows_of_both_signs_are_told_apart() -> None:
    w = np.random.default_rng(6).standard_normal(200)
    w[40:64] += 3.0
    w[64:96] -= 3.0
    first, second = windows_of(w, 2.0)
    assert (first.sign, second.sign) == (1, -1)
    assert abs(first.end - 64) <= 2
    assert abs(second.start - 64) <= 2


@pytest.mark.parametrize("seed", range(10))
def test_windows_never_overlap_and_stand_in_order(seed: int) -> None:
    rng = np.random.default_rng(seed)
    w = 3.0 * np.sin(np.linspace(0.0, 30.0, 300)) + rng.standard_normal(300)
    found = windows_of(w, 1.5)
    assert 4 <= len(found) <= Settings().most_windows
    ends = [0, *(edge for s in found for edge in (s.start, s.end)), 300]
    assert ends == sorted(ends)
    for s in found:
        part = w[s.start : s.end]
        assert s.sign * part.sum() > 0.0
        handicap = np.sqrt(2.0 * np.log(300.0 / part.size))
        assert s.statistic == pytest.approx(abs(part.sum()) / np.sqrt(part.size) - handicap)
        assert s.statistic > 1.5


def test_windows_of_every_channel_are_searched() -> None:
    y = np.random.default_rng(7).standard_normal(linear.TOTAL)
    for channel in range(4):
        y[50 * channel + 20 : 50 * channel + 31] += 5.0
    trial = linear.fit(COLUMNS, y)
    found = lack_of_fit(trial.model, trial.fit, [], np.random.default_rng(2))
    assert [w.channel for w in found.windows] == [0, 1, 2, 3]
    # Residuals are simulated less measured.
    assert {w.sign for w in found.windows} == {-1}
    assert found.scan == max(w.statistic for w in found.windows)
