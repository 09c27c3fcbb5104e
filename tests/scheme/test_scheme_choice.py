"""Noise of records, the rule of the choice, and the choice on records of known truth."""

from dataclasses import dataclass

import numpy as np
import pytest
from scheme_truths import make_scheme_twin

from pyrofit.scheme.choice import choose
from pyrofit.scheme.noise import RecordScatter, deviance, log_density_of_noise, most_likely
from pyrofit.scheme.schemes import Scheme
from pyrofit.scheme.settings import SchemeSettings

SETTINGS = SchemeSettings()


@dataclass(frozen=True)
class FakePosed:
    count: int


@dataclass(frozen=True)
class FakeFit:
    name: str
    posed: FakePosed
    bic: float


@dataclass(frozen=True)
class FakeCandidate:
    fitted: FakeFit
    scores: tuple[float, ...]

    @property
    def left_out(self) -> tuple[float, ...]:
        return self.scores

    @property
    def log_score(self) -> float:
        return sum(self.scores)

    def by_rate(self) -> dict[float, float]:
        return dict(enumerate(self.scores))


def candidate(name: str, count: int, bic: float, *scores: float) -> FakeCandidate:
    return FakeCandidate(FakeFit(name, FakePosed(count), bic), scores)


def chosen(*given: FakeCandidate) -> str:
    return choose(given, SETTINGS)[1].fitted.name  # type: ignore[arg-type]


def test_the_simpler_of_two_that_predict_alike_is_chosen() -> None:
    assert (
        chosen(candidate("many", 9, 0.0, 10, 10, 10), candidate("few", 3, 5.0, 9, 9, 9.5)) == "few"
    )


def test_a_simpler_scheme_that_predicts_worse_is_not_chosen() -> None:
    assert (
        chosen(candidate("many", 9, 0.0, 10, 10, 10), candidate("few", 3, 9.0, 7, 7, 7)) == "many"
    )


def test_a_margin_is_bounded_however_much_rates_differ() -> None:
    # The standard error of the difference is 30; few rates tell it badly.
    assert (
        chosen(candidate("many", 9, 0.0, 40, 10, 10), candidate("few", 3, 9.0, 10, 10, 10))
        == "many"
    )


def test_further_parameters_must_pay_in_the_fit_as_well() -> None:
    given = candidate("many", 9, 9.0, 40, 40, 40), candidate("few", 3, 0.0, 39, 38, 38)
    assert chosen(*given) == "few"


def test_no_fit_makes_up_for_clearly_worse_predictions() -> None:
    given = candidate("many", 9, 9.0, 40, 40, 40), candidate("few", 3, 0.0, 37, 38, 38)
    assert chosen(*given) == "many"


def test_of_as_many_parameters_the_least_bic_is_chosen() -> None:
    assert chosen(candidate("a", 3, 9.0, 5, 5, 5), candidate("b", 3, 1.0, 5, 5, 4)) == "b"


def test_a_scheme_without_predictions_is_not_chosen() -> None:
    assert chosen(candidate("none", 1, 0.0), candidate("some", 3, 9.0, 1, 1, 1)) == "some"


@pytest.fixture(scope="module")
def twin():
    return make_scheme_twin(Scheme(order=True), 11, SETTINGS)


def test_noise_of_a_channel_is_that_of_the_covariance(twin) -> None:
    scatter = RecordScatter(twin.setting.records[0], SETTINGS)
    residual = np.random.default_rng(1).standard_normal(SETTINGS.points)
    white = scatter.noise(0.01).whiten(residual)
    exact = residual @ np.linalg.solve(scatter.covariance(0.01), residual)
    assert white @ white == pytest.approx(exact, rel=1e-3)


def test_deviance_is_minus_twice_the_log_density(twin) -> None:
    scatter = RecordScatter(twin.setting.records[0], SETTINGS)
    residual = 0.01 * np.ones(SETTINGS.points)
    expected = -2.0 * log_density_of_noise(residual, scatter.covariance(0.01))
    assert deviance([scatter], [residual], 0.01) == pytest.approx(expected)


@pytest.mark.parametrize("size", [0.0, 0.01, 0.04])
def test_size_of_the_discrepancy_is_recovered(size: float, twin) -> None:
    rng = np.random.default_rng(2)
    scatters = [RecordScatter(r, SETTINGS) for r in twin.setting.records]
    drawn = [
        rng.multivariate_normal(np.zeros(SETTINGS.points), s.covariance(size)) for s in scatters
    ]
    found = most_likely(scatters, drawn)
    assert found <= 1e-3 if size == 0.0 else size / 1.5 <= found <= 1.5 * size
