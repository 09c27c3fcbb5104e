"""Weights, initial values and own costs of fits, on a TGA record with known noise."""

from pathlib import Path

import numpy as np
import pytest

import pyrofit as pf
from pyrofit.errors import StudyError
from pyrofit.estimate import wrong_model

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
SIGNALS = {"tga_5K": "mass_fraction", "tga_20K": "mass_fraction"}
TRUTH = {"T_p": 605.0, "E_p": 190.0}
FIRST, SECOND = SIGNALS.items()


@pytest.fixture(scope="module")
def study() -> pf.Study:
    return pf.read_study(SMOKE)


@pytest.fixture(scope="module")
def data(study: pf.Study) -> pf.Curves:
    curves = pf.simulate(study, TRUTH, experiments=list(SIGNALS))
    rng = np.random.default_rng(1)
    tables = {
        key: table.assign(mass_fraction=table["mass_fraction"] + rng.normal(0.0, 0.003, len(table)))
        for key, table in curves.items()
    }
    return pf.read_data(study, SIGNALS, tables)


def fitted(study: pf.Study, data: pf.Curves, **options: object) -> pf.Fit:
    return pf.fit(study, data, signals=SIGNALS, **({"starts": 4, "profiles": False} | options))


def test_weight_multiplies_the_residuals_of_its_signal(study: pf.Study, data: pf.Curves) -> None:
    plain = pf.residuals(study, data, signals=SIGNALS)([600.0, 180.0])
    points = len(data[FIRST])
    of_points = np.linspace(1.0, 2.0, points)
    for weight in (2.0, np.full(points, 2.0)):
        double = pf.residuals(study, data, signals=SIGNALS, weights={"tga_5K": weight})
        expected = np.concatenate([2.0 * plain[:points], plain[points:]])
        assert np.allclose(double([600.0, 180.0]), expected, rtol=1e-10)
    by_point = pf.log_likelihood(study, data, signals=SIGNALS, weights={FIRST: of_points})
    assert by_point([600.0, 180.0]) < -0.5 * float(np.sum(plain**2))


def test_weights_change_the_fit_as_their_noise_would(study: pf.Study, data: pf.Curves) -> None:
    shifted = {key: table.copy() for key, table in data.items()}
    shifted[FIRST]["temperature_K"] += 3.0
    shifted = pf.read_data(study, SIGNALS, shifted)
    weights = None, {"tga_5K": 20.0}, {"tga_20K": 20.0}
    fits = [fitted(study, shifted, weights=given) for given in weights]
    values = [fit.values["T_p"] for fit in fits]
    alone = [pf.fit(study, shifted, signals=[key], starts=4, profiles=False) for key in SIGNALS]
    first, second = (fit.values["T_p"] for fit in alone)
    assert second < values[0] < first
    assert abs(values[1] - first) < 0.1 * abs(first - second)
    assert abs(values[2] - second) < 0.1 * abs(first - second)


def test_weights_count_in_the_least_squares_of_a_wrong_model(
    study: pf.Study, data: pf.Curves
) -> None:
    x = np.array([0.3, 0.4])
    plain, weighted = (
        pf.residuals(study, data, signals=SIGNALS, weights=weights).likelihood
        for weights in (None, {"tga_5K": 4.0})
    )
    curves = plain.curves(x)
    noise, own = (wrong_model._by_misfit(of, curves) for of in (plain, weighted))
    assert np.array_equal(own[0].sd, noise[0].sd / 4.0)
    assert np.array_equal(own[1].sd, noise[1].sd)


def test_weights_stand_in_the_fit(study: pf.Study, data: pf.Curves) -> None:
    fit = fitted(study, data, weights={FIRST: 0.5})
    assert {key: float(w) for key, w in fit.weights.items()} == {FIRST: 0.5}
    plain = fitted(study, data)
    ratio = fit.signals["noise_sd"] / plain.signals["noise_sd"]
    assert ratio.tolist() == [2.0, 1.0]
    assert "weights: tga_5K, mass_fraction: 0.5\n" in str(fit)
    assert "weights:" not in str(plain)


def test_search_starts_at_the_initial_values(
    study: pf.Study, data: pf.Curves, monkeypatch: pytest.MonkeyPatch
) -> None:
    from pyrofit.estimate.likelihood import Likelihood

    begun = []
    descend = Likelihood.descend

    def recorded(self: Likelihood, x: np.ndarray, fixed: int | None = None) -> object:
        begun.append(self.values(x))
        return descend(self, x, fixed)

    monkeypatch.setattr(Likelihood, "descend", recorded)
    fit = fitted(study, data, initial={"E_p": 150.0}, starts=1)
    assert np.allclose(begun[0], [610.0, 150e3])  # T_p in the middle of 560 to 660 K
    assert len(fit.history) == 1
    assert fit.values["T_p"] == pytest.approx(605.0, abs=0.5)
    several = fitted(study, data, initial={"E_p": 150.0}, starts=3)
    assert len(several.history) == 3


def test_own_residuals_give_the_fit_of_the_same_cost(study: pf.Study, data: pf.Curves) -> None:

    def rmse(measured: np.ndarray, simulated: np.ndarray) -> np.ndarray:
        return (simulated - measured) / np.sqrt(measured.size)

    own = pf.fit(study, data, signals=[FIRST], cost=rmse)
    assert own.method == "cost rmse, Multistart least squares"
    assert own.cost == pytest.approx(own.signals["rmse"][0], rel=1e-9)
    assert own.values["T_p"] == pytest.approx(605.0, abs=0.5)
    assert own.cost == own.history["cost"].min()


def test_own_cost_that_is_one_number_is_minimised(study: pf.Study, data: pf.Curves) -> None:
    def largest(measured: np.ndarray, simulated: np.ndarray) -> float:
        return float(np.max(np.abs(simulated - measured)))

    fit = pf.fit(study, data, signals=SIGNALS, cost=largest, optimiser="cmaes")
    y, f = fit.comparison.values(FIRST)
    z, g = fit.comparison.values(SECOND)
    assert fit.cost == pytest.approx(np.max(np.abs(f - y)) + np.max(np.abs(g - z)), rel=1e-9)
    assert fit.cost < 0.03


def test_least_squares_of_a_cost_start_at_initial_values_as_well(
    study: pf.Study, data: pf.Curves
) -> None:
    few = pf.read_study(study, **{"imp.least_squares.starts": 1})
    fit = pf.fit(few, data, signals=[FIRST], cost=np.subtract, initial={"T_p": 605.0})
    assert len(fit.history) == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"weights": {"tga_5K": 0.0}}, "weights: those of 'tga_5K' must be a finite number above"),
        ({"weights": {"tga_5K": "high"}}, "weights: that of 'tga_5K' is neither a number"),
        ({"weights": {"tga_5K": [1.0, 2.0]}}, "weights: 2 are given for tga_5K"),
        ({"weights": {"slab_25": 2.0}}, "weights: 'slab_25' is not fitted. Fitted: tga_5K"),
        ({"weights": {"tga_5": 2.0}}, "no experiment 'tga_5'. Did you mean 'tga_5K'"),
        ({"weights": 3.0}, "weights: numbers by experiment are needed.* this is a float"),
        ({"weights": {"tga_5K": 2.0}, "cost": np.subtract}, "weights: a cost has its own"),
        ({"initial": {"T_p": 900.0}}, "initial: 'T_p' is 900 K, outside its limits 560 to 660"),
        ({"initial": {"k": 0.2}}, "initial: 'k' is not estimated here"),
        ({"initial": {"T_q": 0.2}}, "no parameter 'T_q'"),
        ({"initial": 3}, "values by name are needed.* this is a int"),
        ({"initial": TRUTH, "cost": np.subtract, "optimiser": "cmaes"}, "initial: cmaes draws its"),
        ({"cost": lambda: 0.0}, "cost: <lambda>.measured, simulated. fails .* TypeError"),
        ({"cost": lambda y, f: "low"}, "cost: <lambda>.measured, simulated. fails .* ValueError"),
        ({"cost": lambda y, f: -1.0}, "returns the negative cost -1"),
        ({"cost": lambda y, f: np.nan}, "returns a value that is not finite where both are equal"),
        ({"cost": lambda y, f: np.ones((2, 2))}, r"returns an array of the shape \(2, 2\)"),
        ({"cost": lambda y, f: (f - y)[f != y]}, "residuals, and 0 before"),
        ({"cost": 3}, "cost: the name of a cost or a function is needed, and this is a int"),
    ],
)
def test_wrong_option_is_explained(
    options: dict[str, object], message: str, study: pf.Study, data: pf.Curves
) -> None:
    signals = {} if options.get("cost") == 3 else {"signals": SIGNALS}
    with pytest.raises(StudyError, match=message):
        pf.fit(study, data, **signals, **options)
