"""Profiles of strengths: on linear models they are the parabola that the derivatives say."""

import linear
import numpy as np
import pytest
from hidden_effects import HIDDEN, Diagnosed
from linear import TOTAL, column_of

from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import strength_of
from pyrofit.diagnose.judge.profiles import profiles

COLUMNS = linear.random_columns(4, "k_T", "c_T", size=60.0)


def trial(k_T: float, *effects: str) -> FittedModel:
    """Fit effects to a truth with a slope of the conductivity, in typical ones."""
    y = np.random.default_rng(1).standard_normal(TOTAL) + 2.0 * COLUMNS["rho"]
    y = y + k_T * strength_of("k_T")[1].typical * column_of(COLUMNS, "k_T")
    return linear.fit_with(linear.fit(COLUMNS, y), *effects)


def test_profile_of_a_linear_model_is_its_parabola() -> None:
    fitted = trial(0.5, "k_T", "c_T")
    J = fitted.fit.jacobian
    sd = np.sqrt(np.diag(np.linalg.inv(J.T @ J)))
    found = profiles(fitted)
    assert [profile.effect for profile in found] == ["k_T", "c_T"]
    for profile in found:
        _, quantity = strength_of(profile.effect)
        i = fitted.model.position(profile.effect)
        best, step = fitted.strength(profile.effect), sd[i] * (quantity.upper - quantity.lower)
        away = (np.array(profile.value) - best) / step
        # A fit ends where a step promises 0.05 of chi-square.
        assert np.array(profile.rise) == pytest.approx(away**2, abs=0.1)
        reach = 1.96 * np.sqrt(fitted.posterior.dispersion) * step
        assert profile.low == pytest.approx(best - reach, abs=0.05 * step)
        assert profile.high == pytest.approx(best + reach, abs=0.05 * step)
        assert not profile.low_open
        assert not profile.high_open
        assert profile.level == pytest.approx(1.96**2 * fitted.posterior.dispersion)


def test_interval_is_open_where_the_limit_comes_first() -> None:
    (profile,) = profiles(trial(1.99, "k_T"))  # the limit is twice the typical slope, and negative
    assert profile.low_open
    assert profile.low == strength_of("k_T")[1].lower
    assert not profile.high_open


def test_profiles_are_the_same_by_two_processes() -> None:
    fitted = trial(0.5, "k_T", "c_T")
    assert profiles(fitted, 2) == profiles(fitted, 1)


def test_model_without_effects_has_no_profile() -> None:
    assert profiles(trial(0.0)) == []


def test_profile_of_a_simulation_holds_the_truth(diagnosed: Diagnosed) -> None:
    (profile,) = profiles(diagnosed("k_T").search.end)
    assert profile.low <= HIDDEN["k_T"]["k_T"] <= profile.high
    assert min(profile.rise) > -0.1  # nothing lower was met
    assert max(profile.rise) > profile.level
