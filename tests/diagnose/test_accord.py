"""Known values, plausible strengths, and tests that can tell, on linear models."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import linear
import numpy as np
import pytest
from linear import POINTS, TOTAL, column_of

from pyrofit.diagnose.base.fit import weighed
from pyrofit.diagnose.base.fitted import implausible
from pyrofit.diagnose.base.long_run import significant_factor
from pyrofit.diagnose.base.model import model_of, strength_of
from pyrofit.diagnose.base.plausible import plausible_ranges
from pyrofit.diagnose.base.prediction import HELD_OUT, model_predictions
from pyrofit.diagnose.judge.accord import conflicts, deviations, moved_away, wrong_instead
from pyrofit.diagnose.judge.claim_tests import Trust
from pyrofit.diagnose.judge.power import expected_gain
from pyrofit.diagnose.judge.weights import group_weights
from pyrofit.diagnose.search.step import SearchStep
from pyrofit.diagnose.search.stepwise import Search
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.estimate.prior import NormalPrior
from pyrofit.solver.arrays import FloatArray

CONDITIONS = [name for name, e in known_effects().items() if not e.is_shared]


def orthonormal(count: int) -> FloatArray:
    q, _ = np.linalg.qr(np.random.default_rng(3).standard_normal((TOTAL, count)))
    return np.asarray(q)


def pair(held_out_k: float) -> tuple[linear.FittedModel, linear.FittedModel]:
    """Return fits with k_T and without it; it shows beside k only as far as k leaves 0 +- 1.

    The data are 10 w. Without k_T, k adds w - 3 e, of which k_T can take the e away.
    """
    w, e, rho = orthonormal(3).T
    name = linear.strength_name("k_T")
    typical = strength_of("k_T")[1].typical
    columns = {"rho": rho, "k": w - 3.0 * e, name: (e + held_out_k * w) * 10.0 / typical}
    known = NormalPrior((1,), np.array([0.0]), np.array([1.0]))
    without = linear.fit(columns, 10.0 * w, known=known)
    return linear.fit_with(without, "k_T"), without


@pytest.mark.parametrize(("share", "found"), [(0.0, ["k"]), (1.0, [])])
def test_effect_that_gains_only_by_moving_a_known_value_is_in_conflict(
    share: float, found: list[str]
) -> None:
    own, without = pair(share)
    (of_known,) = conflicts([(own, without)], lambda trial: trial.penalised, 8.0)
    assert of_known == found
    if found:
        assert moved_away(own, without) == ["k"]
        assert deviations(own)[0] == pytest.approx(5.0, abs=0.2)
        assert without.penalised - own.penalised > 8.0


def test_plausible_range_counts_as_a_known_value_of_the_strength() -> None:
    columns = linear.random_columns(2, "flux_spread", size=30.0)
    y = np.random.default_rng(5).standard_normal(TOTAL) + 0.2 * column_of(columns, "flux_spread")
    base = linear.base(columns, y)
    plain = linear.fitted(model_of(base, {"flux_spread": ("spread",)}))
    known = replace(base, plausible=plausible_ranges({"flux_spread": (0.0, 0.002)}))
    model = model_of(known, {"flux_spread": ("spread",)})
    bound = linear.fitted(model)
    # A strength s of sd s_d from the data and sd 0.001 about 0: the mean, weighed by 1/sd^2.
    s_d = np.sqrt(plain.posterior.covariance()[2, 2]) * 0.3
    free = plain.strength("flux_spread")
    expected = free / (1.0 + s_d**2 / 0.001**2)
    assert bound.strength("flux_spread") == pytest.approx(expected, rel=0.02)
    assert implausible(bound, "flux_spread") == pytest.approx(expected / 0.001, rel=0.02)
    assert implausible(plain, "flux_spread") == 0.0
    assert model.absent == len(known.plausible) - 1
    x = bound.fit.x
    J = model.jacobian(x, model.residuals(x))
    for i in range(x.size):
        step = np.where(np.arange(x.size) == i, 1e-6, 0.0)
        slope = (model.residuals(x + step) - model.residuals(x - step)) / 2e-6
        assert J[:, i] == pytest.approx(slope, abs=1e-4 * max(1.0, float(np.abs(slope).max())))


@pytest.mark.parametrize("name", CONDITIONS)
def test_every_effect_of_apparatus_or_surroundings_has_a_plausible_range(name: str) -> None:
    (quantity,) = known_effects()[name].strength.values()
    assert quantity.plausible is not None
    low, high = quantity.plausible
    assert quantity.lower <= low <= quantity.value <= high <= quantity.upper
    assert low <= quantity.typical <= high


def test_expected_gain_is_that_of_the_predictive_distribution() -> None:
    columns = linear.random_columns(4, "k_T", size=40.0)
    hidden = 0.5 * strength_of("k_T")[1].typical
    y = np.random.default_rng(1).standard_normal(TOTAL) + 2.0 * columns["rho"] - columns["k"]
    y = y + hidden * column_of(columns, "k_T")
    base = linear.fit(columns, y, calibrated=(0, 1, 2))
    own, without = model_predictions([linear.fit_with(base, "k_T"), base])
    out = np.arange(TOTAL) >= 3 * POINTS
    whole = linear.fit(columns, y)
    J = linear.fraction_columns(columns, whole.model)
    after = np.linalg.inv(UNIFORM * np.eye(2) + J[~out].T @ J[~out])
    covariance = np.eye(POINTS) + J[out] @ after @ J[out].T
    every = (0, 1, 2, 3)
    models = [model_of(base.model.base, t.model.effects, every) for t in (own.whole, base)]
    x = [own.parts[HELD_OUT].fit.x, base.fit.x]
    d = models[0].residuals(x[0])[:TOTAL][out] - models[1].residuals(x[1])[:TOTAL][out]
    exact = 0.5 * d @ np.linalg.solve(covariance, d)
    assert expected_gain(own, without, HELD_OUT) == pytest.approx(exact, rel=0.01)


def test_prediction_without_power_says_nothing() -> None:
    place = f"{HELD_OUT}: A"
    gains = {"a": 30.0, place: -30.0}
    assert not Trust("", 1.0, gains, True).predicts
    blind = Trust("", 1.0, gains, True, powers={"a": 20.0, place: 0.5})
    assert blind.predicts
    assert blind.confirmed
    assert place not in blind.telling
    assert not Trust("", 1.0, gains, True, powers={"a": 20.0, place: 2.5}).predicts


def test_known_values_weigh_more_beside_signals_that_are_missed_for_long() -> None:
    """Only signals that tell of the known parameter count, each by its own misfit."""
    columns = linear.random_columns(6, size=60.0)
    first = np.arange(TOTAL) < POINTS
    noise = np.random.default_rng(2).standard_normal(TOTAL)
    misfit = 6.0 * np.sin(np.arange(TOTAL) / 8.0) * first
    known = NormalPrior((1,), np.array([0.0]), np.array([0.5]))
    for where, weighs in ((first, True), (~first, False)):
        shown = {**columns, "k": columns["k"] * where}
        trial = weighed(linear.fit(shown, noise + misfit, known=known))
        weight = trial.model.base.likelihood.prior.heaviest
        assert (weight > 2.0) == weighs, weight


def test_noise_hardly_ever_weighs_known_values() -> None:
    rng = np.random.default_rng(4)
    level = Settings().lasting_level
    factors = [significant_factor(rng.standard_normal(200), level) for _ in range(1000)]
    assert sum(factor > 1.0 for factor in factors) <= 15


def test_weight_of_a_group_is_the_share_of_the_models_that_have_it() -> None:
    columns = linear.random_columns(4, "k_T", "c_T", size=40.0)
    y = np.random.default_rng(1).standard_normal(TOTAL)
    y = y + 0.2 * strength_of("k_T")[1].typical * column_of(columns, "k_T")
    base = linear.fit(columns, y)
    trials = tuple(linear.fit_with(base, name) for name in ("k_T", "c_T"))
    adequate = cast(Any, SimpleNamespace(adequate=True))
    found = Search((SearchStep(base, lambda: adequate, (), trials),), trials[0], adequate, 7.0)
    weights = group_weights(found)
    ends = {(): base.penalised} | {t.effects: t.penalised + found.spare for t in trials}
    least = min(ends.values())
    share = {key: np.exp(-0.5 * (end - least)) for key, end in ends.items()}
    for name in ("k_T", "c_T"):
        group = known_effects()[name].group
        assert weights[group] == pytest.approx(share[name,] / sum(share.values()))
    assert next(iter(weights)) == known_effects()["k_T"].group


def test_known_value_that_may_be_wrong_instead_of_an_effect_is_named() -> None:
    """The data ask for k = 8, known as 0 +- 1. Either k is wrong, or an effect adds the same."""
    w, other, rho = orthonormal(3).T
    typical = strength_of("k_T")[1].typical
    known = NormalPrior((1,), np.array([0.0]), np.array([1.0]))
    for alike, found in ((True, ["k"]), (False, [])):
        column = (w if alike else other) * 10.0 / typical
        columns = {"rho": rho, "k": w, linear.strength_name("k_T"): column}
        without = linear.fit(columns, 8.0 * (w if alike else w + other), known=known)
        own = linear.fit_with(without, "k_T")
        (wrong,) = wrong_instead([(own, without)], lambda trial: trial.penalised, 9.0)
        assert wrong == found
