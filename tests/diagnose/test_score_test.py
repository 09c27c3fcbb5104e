"""What an effect changes that parameters cannot imitate, on models worked out by hand."""

import linear
import numpy as np
import pytest
from small import TRUTH, base_of, study

from pyrofit.config import candidate_effects
from pyrofit.diagnose.base.descent import Fit
from pyrofit.diagnose.base.model import extended, fraction, model_of, strength_of
from pyrofit.diagnose.search.refit import look_at
from pyrofit.diagnose.search.score_test import Screening, confusability, strengths_tried
from pyrofit.diagnose.settings import Settings
from pyrofit.effects import known_effects
from pyrofit.estimate.posterior import UNIFORM
from pyrofit.estimate.projection import project, projector
from pyrofit.solver.arrays import FloatArray


def fit_of(J: FloatArray, r: FloatArray, x: FloatArray | None = None) -> Fit:
    x = np.full(J.shape[1], 0.5) if x is None else x
    return Fit(float(r @ r), x, r, J)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(3)


def test_projection_is_that_of_the_formula(rng: np.random.Generator) -> None:
    J, w = 3.0 * rng.standard_normal((20, 4)), rng.standard_normal(20)
    P = np.eye(20) - J @ np.linalg.inv(J.T @ J + 12.0 * np.eye(4)) @ J.T
    assert project(projector(fit_of(J, w)), w) == pytest.approx(P @ w, abs=1e-12)
    assert pytest.approx(1.0 / np.var(np.linspace(0.0, 1.0, 100001)), rel=1e-3) == UNIFORM


def test_projection_is_orthogonal_to_all_that_is_fitted(rng: np.random.Generator) -> None:
    J, w = 1e6 * rng.standard_normal((20, 4)), rng.standard_normal((20, 3))
    left = project(projector(fit_of(J, w[:, 0])), w)
    cosine = (J / np.linalg.norm(J, axis=0)).T @ left
    assert np.abs(cosine).max() < 1e-9
    assert np.linalg.norm(left, axis=0).min() > 1.0


def test_what_a_parameter_does_exactly_is_projected_away(rng: np.random.Generator) -> None:
    J = 1e4 * rng.standard_normal((20, 4))
    assert np.abs(project(projector(fit_of(J, np.zeros(20))), J[:, 2])).max() < 1e-3
    assert np.abs(J[:, 2]).max() > 1e3


@pytest.mark.parametrize(("limit", "pushed"), [(0.0, 1.0), (1.0, -1.0)])
def test_parameter_pressed_to_a_limit_takes_nothing_away(limit: float, pushed: float) -> None:
    J = 1e4 * np.eye(6)[:, :2]
    r = pushed * np.array([1.0, 0.0, 2.0, 0.0, 0.0, 0.0])
    w = np.ones(6)
    resting = project(projector(fit_of(J, r, np.array([limit, 0.5]))), w)
    assert resting == pytest.approx([1.0, 0.0, 1.0, 1.0, 1.0, 1.0], abs=1e-6)
    leaving = project(projector(fit_of(J, -r, np.array([limit, 0.5]))), w)
    assert leaving == pytest.approx([0.0, 0.0, 1.0, 1.0, 1.0, 1.0], abs=1e-6)


# --- looks ----------------------------------------------------------------------------------

COLUMNS = linear.random_columns(1, "k_T", "c_T", "heater_ramp", size=30.0)


@pytest.fixture
def noise(rng: np.random.Generator) -> FloatArray:
    return rng.standard_normal(linear.TOTAL)


def looked(y: FloatArray, effect: str) -> tuple[linear.FittedModel, Screening]:
    trial = linear.fit(COLUMNS, y)
    (found,) = look_at(trial, [effect])
    return trial, found


def test_look_is_what_the_strengths_change(noise: FloatArray) -> None:
    _, found = looked(noise, "k_T")
    column = COLUMNS[linear.strength_name("k_T")]
    assert found.raw == pytest.approx(np.outer(column, found.strengths), abs=1e-9)


def test_score_of_a_residual_made_of_an_effect_is_its_size(noise: FloatArray) -> None:
    _, found = looked(noise, "k_T")
    for i, size in enumerate(found.sizes):
        assert size > 1.0
        assert found.score(-found.changes[:, i]) == pytest.approx(size, rel=1e-12)
        # The model lacks the effect: measured less simulated is what the effect would add.
        assert found.score(-7.0 * found.changes[:, i]) == pytest.approx(7.0 * size, rel=1e-12)


def test_score_of_an_effect_of_one_side_does_not_count_the_other(noise: FloatArray) -> None:
    _, found = looked(noise, "heater_ramp")
    lacking = found.changes[:, found.typical]
    assert found.score(-lacking) == pytest.approx(found.detectability, rel=1e-12)
    assert found.score(lacking) == 0.0


def test_score_of_a_hidden_effect_is_its_detectability_but_for_noise(noise: FloatArray) -> None:
    name, quantity = linear.strength_name("c_T"), strength_of("c_T")[1]
    trial, found = looked(noise + quantity.typical * COLUMNS[name], "c_T")
    assert found.strengths[found.typical] == quantity.typical
    assert found.score(trial.fit.residuals) == pytest.approx(found.detectability, abs=3.0)
    assert found.detectability > 20.0


def test_fall_of_chi_square_ahead_is_what_a_joint_fit_at_that_strength_reaches(
    noise: FloatArray,
) -> None:
    name, quantity = linear.strength_name("c_T"), strength_of("c_T")[1]
    trial, found = looked(noise + quantity.typical * COLUMNS[name], "c_T")
    J = linear.fraction_columns(COLUMNS, trial.model)
    for strength, ahead in zip(found.strengths, found.ahead, strict=True):
        y = noise + (quantity.typical - strength) * COLUMNS[name]
        least = float(np.sum((y - J @ np.linalg.lstsq(J, y, rcond=None)[0]) ** 2))
        assert ahead == pytest.approx(least, rel=0.01)


def test_confusability_is_the_cosine_of_what_is_left(noise: FloatArray) -> None:
    names = ("k_T", "c_T", "heater_ramp")
    trial = linear.fit(COLUMNS, noise)
    looks = look_at(trial, names)
    cosine = confusability(looks)
    assert np.diag(cosine) == pytest.approx(np.ones(3))
    J = linear.fraction_columns(COLUMNS, trial.model)
    left = []
    for name in names:
        d = COLUMNS[linear.strength_name(name)] * strength_of(name)[1].typical
        left.append(d - J @ np.linalg.solve(J.T @ J + 12.0 * np.eye(2), J.T @ d))
    expected = left[0] @ left[1] / np.linalg.norm(left[0]) / np.linalg.norm(left[1])
    assert cosine[0, 1] == pytest.approx(expected, abs=1e-6)
    assert abs(expected) > 0.02
    assert cosine == pytest.approx(cosine.T)


def test_effect_that_another_one_excludes_is_not_looked_at(noise: FloatArray) -> None:
    trial = linear.fit_with(linear.fit(COLUMNS, noise), "in_depth")
    assert [found.effect for found in look_at(trial, ["in_depth_lost", "k_T"])] == ["k_T"]


# --- strengths ------------------------------------------------------------------------------


@pytest.mark.parametrize("effect", known_effects())
def test_strengths_lie_within_the_limits_on_every_side_of_the_null_that_has_room(
    effect: str,
) -> None:
    _, quantity = strength_of(effect)
    found = strengths_tried(effect, Settings().tried_strengths, Settings().near_limit)
    margin = 0.019 * (quantity.upper - quantity.lower)
    assert found.min() > quantity.lower + margin
    assert found.max() < quantity.upper - margin
    assert quantity.value not in found
    assert np.unique(found).size == found.size
    assert bool(np.any(found > quantity.value)) == (quantity.upper - quantity.value > margin * 1.1)
    assert bool(np.any(found < quantity.value)) == (quantity.value - quantity.lower > margin * 1.1)


@pytest.mark.parametrize("effect", known_effects())
def test_typical_strength_is_tried_and_weak_ones_come_first(effect: str) -> None:
    _, quantity = strength_of(effect)
    found = strengths_tried(effect, Settings().tried_strengths, Settings().near_limit)
    span = quantity.upper - quantity.lower
    assert np.abs(found - quantity.typical).min() < 0.021 * span
    distance = np.abs(found - quantity.value)
    towards = distance[
        np.sign(found - quantity.value) == np.sign(quantity.typical - quantity.value)
    ]
    assert np.all(np.diff(towards) > 0.0)


@pytest.mark.parametrize("effect", candidate_effects(study()))
def test_effect_at_its_null_value_leaves_the_base_exactly(effect: str) -> None:
    base = base_of(study())
    x = base.likelihood.scaled(np.array(list(TRUTH.values())))
    name, quantity = strength_of(effect)
    model = model_of(base, {effect: (name,)})
    at_null = extended(x, effect, quantity.value)
    assert at_null[-1] == fraction(quantity, quantity.value)
    assert np.array_equal(model.residuals(at_null), model_of(base, {}).residuals(x))
