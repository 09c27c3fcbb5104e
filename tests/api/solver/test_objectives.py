"""Residuals and log-likelihood of a study as functions of a vector."""

from pathlib import Path

import numpy as np
import pytest

import pyrofit as pf
from pyrofit.errors import StudyError

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
KEY = ("tga_5K", "mass_fraction")
WRONG = [
    ([600.0], "the shape is"),
    ("high", "numbers are needed"),
    (None, "the shape is"),
    ({"T_p": 600.0}, "give exactly T_p, E_p"),
    ({"T_p": 600.0, "E_p": 190.0, "k": 0.2}, "give exactly T_p, E_p"),
    (np.ones((2, 2, 2)), "the shape is"),
]


@pytest.fixture(scope="module")
def study() -> pf.Study:
    return pf.read_study(SMOKE)


@pytest.fixture(scope="module")
def data(study: pf.Study) -> pf.Curves:
    curve = pf.simulate(study, study.synthetic.truth, experiments="tga_5K")[KEY]
    noise = 0.003 * np.random.default_rng(1).standard_normal(len(curve))
    table = curve.assign(mass_fraction=curve["mass_fraction"] + noise)
    return pf.read_data(study, "tga_5K", {KEY: table})


def test_squares_of_the_residuals_are_the_chi_square_of_the_fit(
    study: pf.Study, data: pf.Curves
) -> None:
    fit = pf.fit(study, data, signals="tga_5K", starts=4, profiles=False)
    residuals = pf.residuals(study, data, signals="tga_5K", about=fit.values)
    likelihood = pf.log_likelihood(study, data, signals="tga_5K", about=fit.values)
    assert residuals.names == tuple(fit.table.index)
    assert np.array_equal(residuals.limits, fit.table[["lower", "upper"]])
    best = fit.table["value"].to_numpy()
    chi2 = float(np.sum(residuals(best) ** 2))
    # The fit takes its noise about the end of its first descent, which the last one moves a little.
    assert chi2 == pytest.approx(fit.chi2, rel=1e-3)
    with pytest.raises(StudyError, match="about: there is no value of E_p"):
        pf.residuals(study, data, signals="tga_5K", about={"T_p": 605.0})
    assert likelihood(best) == pytest.approx(-0.5 * chi2, rel=1e-12)
    assert likelihood(best) > likelihood(best * (1.001, 1.0))


def test_vectors_side_by_side_have_the_values_of_each(study: pf.Study, data: pf.Curves) -> None:
    X = np.array([[605.0, 190.0], [610.0, 200.0], [700.0, 190.0]])
    residuals = pf.residuals(study, data, signals="tga_5K")
    likelihood = pf.log_likelihood(study, data, signals="tga_5K")
    assert np.array_equal(residuals(X), [residuals(x) for x in X])
    assert np.array_equal(residuals(dict(zip(residuals.names, X[0], strict=True))), residuals(X[0]))
    assert likelihood(X).tolist() == [likelihood(x) for x in X]
    assert likelihood(X[2]) == -np.inf  # outside the limits
    assert isinstance(likelihood(X[0]), float)


@pytest.mark.parametrize(("wrong", "message"), WRONG)
def test_wrong_vector_is_explained(
    wrong: object, message: str, study: pf.Study, data: pf.Curves
) -> None:
    with pytest.raises(StudyError, match=message):
        pf.log_likelihood(study, data, signals="tga_5K")(wrong)


def test_numbers_that_are_not_finite_have_no_likelihood_and_no_residuals(
    study: pf.Study, data: pf.Curves
) -> None:
    likelihood = pf.log_likelihood(study, data, signals="tga_5K")
    assert likelihood([605.0, np.nan]) == -np.inf
    table = [[605.0, 190.0], [np.nan, 190.0], [605.0, -np.inf]]
    assert np.isfinite(likelihood(table)).tolist() == [True, False, False]
    with pytest.raises(StudyError, match="a number is not finite"):
        pf.residuals(study, data, signals="tga_5K")([605.0, np.nan])


def test_function_is_shown_by_its_parameters_and_limits(study: pf.Study, data: pf.Curves) -> None:
    shown = "study 'smoke'\n  T_p: 560 to 660 K\n  E_p: 100 to 300 kJ/mol"
    assert repr(pf.residuals(study, data, signals="tga_5K")) == f"residuals of {shown}"
    assert repr(pf.log_likelihood(study, data, signals="tga_5K")) == f"log-likelihood of {shown}"
