"""Disturbed data: how they are drawn, and the diagnosis of them."""

import numpy as np
import pytest
from small import base_of, measured, study
from small import clean as clean_curves

from pyrofit.diagnose.base.disturbed import disturbed, drawn
from pyrofit.diagnose.base.model import Base
from pyrofit.diagnose.diagnosis import DiagnosisWork, examine
from pyrofit.diagnose.settings import Settings
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.noise import NoiseModel
from pyrofit.solver.arrays import FloatArray

SEED = 2
POINTS = 60
NOISES = {
    "white": NoiseModel(np.linspace(0.5, 2.0, POINTS), Correlation()),
    "lags": NoiseModel(np.full(POINTS, 3e-4), Correlation(lags=(-0.25, -0.2))),
    "lasting": NoiseModel(np.full(POINTS, 1.0), Correlation(ar=0.8)),
    "between repeats": NoiseModel(
        np.full(POINTS, 1.0), Correlation(ar=0.5), modes=np.linspace(0.0, 3.0, POINTS)[:, None]
    ),
}


def values(base: Base) -> list[FloatArray]:
    return [term.target.value for _, term in base.likelihood.problem.cost.terms]


@pytest.mark.parametrize("noise", NOISES.values(), ids=NOISES)
def test_drawn_noise_is_white_and_of_unit_variance_once_whitened(noise: NoiseModel) -> None:
    rng = np.random.default_rng(1)
    white = np.array([noise.whiten(drawn(noise, rng)) for _ in range(400)])
    assert float(np.mean(white**2)) == pytest.approx(1.0, abs=0.03)
    covariance = white.T @ white / len(white)
    assert float(np.abs(covariance - np.diag(np.diag(covariance))).max()) < 0.27


def test_measured_values_change_by_the_stated_part_of_their_noise() -> None:
    base = base_of(study(), clean_curves({}))
    other = disturbed(base, 7)
    changes = [o - v for o, v in zip(values(other), values(base), strict=True)]
    shares = [c / n.sd for c, n in zip(changes, base.likelihood.noise, strict=True)]
    assert float(np.std(np.concatenate(shares))) == pytest.approx(Settings().disturbance, rel=0.15)
    assert other.likelihood.noise == base.likelihood.noise
    assert other.calibrated == base.calibrated


def test_a_seed_determines_the_disturbance() -> None:
    base = base_of(study(), clean_curves({}))
    once, again, others = (np.concatenate(values(disturbed(base, seed))) for seed in (7, 7, 8))
    assert np.array_equal(once, again)
    assert not np.any(once == others)


def test_measured_curves_of_the_base_stay_as_they_are() -> None:
    base = base_of(study(), clean_curves({}))
    before = [v.copy() for v in values(base)]
    disturbed(base, 7)
    assert all(np.array_equal(a, b) for a, b in zip(values(base), before, strict=True))


CANDIDATES = ["heater_ramp", "k_T", "c_T", "back_loss"]


@pytest.fixture(scope="module")
def late_heater() -> list[DiagnosisWork]:
    """Return the diagnosis of a late heater as measured, of draw 0 twice, and of draw 1."""
    given, data = study(effects=CANDIDATES), measured({"heater_ramp": 8.0}, SEED)
    return [examine(given, data, advise=False, draw=draw) for draw in (None, 0, 0, 1)]


def test_a_clear_effect_is_named_from_disturbed_data(late_heater: list[DiagnosisWork]) -> None:
    for found in late_heater:
        assert found.content.verdict.effects == ["heater_ramp"]


def test_each_draw_changes_the_data_and_the_same_draw_gives_the_same_bits(
    late_heater: list[DiagnosisWork],
) -> None:
    measured_chi2, first, again, second = (found.search.end.fit.chi2 for found in late_heater)
    assert first == again
    assert len({measured_chi2, first, second}) == 3
    assert first == pytest.approx(measured_chi2, rel=0.1)


def test_processes_do_not_change_a_draw(late_heater: list[DiagnosisWork]) -> None:
    given, data = study(effects=CANDIDATES), measured({"heater_ramp": 8.0}, SEED)
    found = examine(given, data, processes=2, advise=False, draw=0)
    assert found.content == late_heater[1].content
