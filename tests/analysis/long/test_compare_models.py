"""Comparisons of models: their criteria, false alarms, and predictions of left-out rates."""

from pathlib import Path

import numpy as np
import pytest

import pyrofit as pf
from pyrofit.analysis.model_comparison import (
    CommonNoise,
    effective_points,
    f_test,
    f_test_of_lasting,
    inflation_of,
)
from pyrofit.errors import StudyError
from pyrofit.solver.arrays import FloatArray

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
RATES = ["tga_5K", "tga_20K"]
ORDER = {
    "parameters.n": {"unit": "-", "lower": 0.5, "upper": 2.5},
    "material.reactions.pyrolysis.order": "n",
    "kinetics.estimate": ["T_p", "E_p", "n"],
    "synthetic.truth.n": 1.0,
}
STUDIES = {"first": pf.read_study(SMOKE), "nth": pf.read_study(SMOKE, **ORDER)}


def records(order: float, waves: float = 0.0) -> pf.Curves:
    truth = {"T_p": 605.0, "E_p": 190.0, "n": order}
    curves = pf.simulate(STUDIES["nth"], truth, experiments=RATES)
    rng, tables = np.random.default_rng(2), {}
    for key, table in curves.items():
        error = rng.normal(0.0, 0.003, len(table))
        error += waves * np.sin(table["temperature_K"] / 8.0)
        tables[key] = table.assign(mass_fraction=table["mass_fraction"] + error)
    return pf.read_data(STUDIES["nth"], RATES, tables)


def fitted(data: pf.Curves, **options: object) -> dict[str, pf.Fit]:
    return {
        name: pf.fit(study, data, signals=RATES, starts=4, profiles=False, **options)
        for name, study in STUDIES.items()
    }


@pytest.fixture(scope="module")
def of_first_order() -> dict[str, pf.Fit]:
    return fitted(records(1.0))


@pytest.fixture(scope="module")
def of_third_half() -> dict[str, pf.Fit]:
    return fitted(records(1.3))


def test_model_without_the_order_loses_where_the_order_is_another(
    of_third_half: dict[str, pf.Fit],
) -> None:
    table = pf.compare_models(of_third_half)
    assert table.index.tolist() == ["nth", "first"]
    assert table["parameters"].tolist() == [3, 2]
    assert table["describes"].tolist() == [True, False]
    assert table.loc["nth", "against"] == "first"
    assert table.loc["nth", "p"] < 1e-10
    assert table.loc["first", "d_bic"] > 100.0
    assert table.loc["nth", "weight"] > 0.999
    scores = table["log_score"]
    assert scores["nth"] - scores["first"] > 50.0
    assert table.loc["nth", "left_out_rms"] < 0.2 * table.loc["first", "left_out_rms"]


def test_model_with_a_superfluous_order_gains_nothing(of_first_order: dict[str, pf.Fit]) -> None:
    table = pf.compare_models(of_first_order, left_out=False)
    assert table.index.tolist() == ["first", "nth"]
    assert table.loc["nth", "p"] > 0.05
    assert 0.0 < table.loc["nth", "d_bic"] < np.log(300.0)
    # Each criterion as its formula says.
    assert table["effective"].tolist() == [300.0, 300.0]
    for name, fit in of_first_order.items():
        row, k = table.loc[name], len(fit.table)
        # Here the noise is about the end of the fit, there about the end of its first descent.
        assert row["chi2"] == pytest.approx(fit.chi2, rel=1e-3)
        assert row["bic"] == pytest.approx(row["chi2"] + k * np.log(300.0), rel=1e-12)
        few = 2.0 * k * (k + 1) / (300.0 - k - 1)
        assert row["aicc"] == pytest.approx(row["chi2"] + 2 * k + few, rel=1e-12)
    first, nth = table.loc["first", "chi2"], table.loc["nth", "chi2"]
    assert table.loc["nth", "F"] == pytest.approx((first - nth) / (nth / 297.0), rel=1e-9)
    assert "log_score" not in table


def test_left_out_rate_is_predicted_from_the_others(of_first_order: dict[str, pf.Fit]) -> None:
    told: list[str] = []
    table = pf.compare_models(of_first_order, tell=told.append)
    fit = of_first_order["first"]
    data = dict(fit.comparison.measured)
    squares = []
    for left, other in (RATES, RATES[::-1]):
        alone = pf.fit(STUDIES["first"], data, signals=[other], starts=4, profiles=False)
        y, f = alone.predict(left, data).values((left, "mass_fraction"))
        squares.append(np.mean((f - y) ** 2) / np.ptp(y) ** 2)
    # The fits to one rate have their noise about their own curves.
    assert table.loc["first", "left_out_rms"] == pytest.approx(np.sqrt(np.mean(squares)), rel=0.04)
    assert [line.split(" predicted")[0] for line in told[:2]] == [
        "first: 5 K/min",
        "first: 20 K/min",
    ]
    assert abs(table["log_score"].diff().iloc[-1]) < 3.0


def test_fits_read_from_json_have_the_same_comparison(of_first_order: dict[str, pf.Fit]) -> None:
    again = {name: pf.Fit.from_json(fit.to_json()) for name, fit in of_first_order.items()}
    tables = [pf.compare_models(fits, left_out=False) for fits in (of_first_order, again)]
    assert tables[0].equals(tables[1])


def test_lasting_misfit_leaves_fewer_points() -> None:
    fits = fitted(records(1.0, waves=0.03))
    table = pf.compare_models(list(fits.values()), left_out=False)
    assert set(table.index) == {"model 1", "model 2"}
    assert not table["describes"].any()
    assert (table["effective"] < 150.0).all()
    plain = min(fit.chi2 for fit in fits.values())
    assert table["chi2"].min() < 0.5 * plain


def basis(points: int, degree: int) -> FloatArray:
    t = np.linspace(-1.0, 1.0, points)
    return np.linalg.qr(np.polynomial.legendre.legvander(t, degree))[0]


def p_of_superfluous(noise: FloatArray, degrees: tuple[int, int]) -> tuple[float, float]:
    """Return p of superfluous parameters where errors may last, and with all points."""
    small, large = (basis(noise.size, degree) for degree in degrees)
    r, w = (noise - Q @ (Q.T @ noise) for Q in (small, large))
    added, rest = degrees[1] - degrees[0], noise.size - degrees[1] - 1.0
    plain = f_test(float(r @ r), float(w @ w), added, rest)[1]
    f, freedom = inflation_of(w, large)
    common = CommonNoise((), (effective_points(w, f),), (freedom,))
    lasting = f_test_of_lasting([r / np.sqrt(f)], [w / np.sqrt(f)], added, common)[1]
    return (lasting if freedom < np.inf else plain), plain


def lasting_noise(correlation: float, share: float, seed: int) -> FloatArray:
    """Return white noise of unit variance, and a share of errors that last."""
    rng = np.random.default_rng([3, seed])
    steps, error = rng.standard_normal(600) * np.sqrt(1.0 - correlation**2), np.zeros(600)
    for i in range(1, 600):
        error[i] = correlation * error[i - 1] + steps[i]
    return rng.standard_normal(300) + share * error[300:]


@pytest.mark.parametrize("degrees", [(2, 3), (1, 3)])
@pytest.mark.parametrize(
    ("correlation", "share", "least_plain"),
    [(0.0, 0.0, 0.01), (0.5, 1.0, 0.12), (0.9, 1.0, 0.35), (0.9, 3.0, 0.5)],
)
def test_superfluous_parameter_is_seldom_claimed(
    correlation: float, share: float, least_plain: float, degrees: tuple[int, int]
) -> None:
    found = [p_of_superfluous(lasting_noise(correlation, share, i), degrees) for i in range(300)]
    counted, plain = np.mean(np.array(found) < 0.05, axis=0)
    assert counted <= 0.09
    assert plain > least_plain


def test_clear_gain_is_claimed_though_errors_last() -> None:
    wanted = 25.0 * basis(300, 3)[:, 3]
    found = [p_of_superfluous(wanted + lasting_noise(0.9, 1.0, i), (2, 3))[0] for i in range(60)]
    assert np.mean(np.array(found) < 0.05) > 0.8


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda fits: fits["first"], "compare_models: fits by name are needed.* this is a Fit"),
        (lambda fits: [fits["first"]], "compare_models: 1 fit is given; give two or more"),
        (lambda fits: {**fits, "x": 3}, "compare_models: 'x' is a int; give a fit of `pf.fit`"),
    ],
)
def test_wrong_models_are_explained(
    change: object, message: str, of_first_order: dict[str, pf.Fit]
) -> None:
    with pytest.raises(StudyError, match=message):
        pf.compare_models(change(of_first_order))


def test_models_of_other_measurements_weights_or_costs_are_refused(
    of_first_order: dict[str, pf.Fit], of_third_half: dict[str, pf.Fit]
) -> None:
    fit = of_first_order["first"]
    data = dict(fit.comparison.measured)
    with pytest.raises(StudyError, match="'nth' and 'first' are fits of other measurements"):
        pf.compare_models({"first": fit, "nth": of_third_half["nth"]})
    weighted = pf.fit(
        fit.study, data, signals=RATES, weights={"tga_5K": 2.0}, starts=2, profiles=False
    )
    with pytest.raises(StudyError, match="'b' and 'a' have other weights"):
        pf.compare_models({"a": fit, "b": weighted}, left_out=False)
    cost = pf.fit(fit.study, data, signals=RATES, cost=np.subtract)
    with pytest.raises(StudyError, match="'b' is a fit of a cost, which has no likelihood"):
        pf.compare_models({"a": fit, "b": cost})
