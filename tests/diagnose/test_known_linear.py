"""What is known of parameters, in the diagnosis of linear models: the answers are Gauss's."""

import linear
import numpy as np
import pytest
from small import study

from pyrofit.diagnose.base.descent import descend_chi_square, refreshed
from pyrofit.diagnose.base.fit import weighed
from pyrofit.diagnose.base.fitted import FittedModel
from pyrofit.diagnose.base.model import strength_of
from pyrofit.diagnose.judge.intervals import values_of
from pyrofit.diagnose.search.step import SearchContext
from pyrofit.diagnose.search.stepwise import search_effects
from pyrofit.estimate.prior import NO_PRIOR, NormalPrior, within_known
from pyrofit.solver.arrays import FloatArray

# Less noise than is stated: no misfit widens the intervals.
MEASURED = 0.9 * np.random.default_rng(8).standard_normal(linear.TOTAL)


def columns() -> dict[str, FloatArray]:
    """Return columns of two parameters that are correlated by -0.7."""
    found = linear.random_columns(3)
    return {"rho": found["rho"] + found["k"], "k": found["k"]}


def design() -> FloatArray:
    return np.column_stack([columns()[name] for name in linear.NAMES])


def fitted(known: NormalPrior) -> tuple[FloatArray, FloatArray]:
    """Return values and standard deviations of a fit that is followed to its very end."""
    model = linear.fit(columns(), MEASURED, known=known).model
    end = descend_chi_square(model, np.full(2, 0.5), enough=1e-12)
    return values_of(FittedModel(model, refreshed(model, end)))


@pytest.mark.parametrize("sd", [1.0, 0.1, 0.01])
def test_interval_is_that_of_the_normal_posterior(sd: float) -> None:
    X = design()
    values, sds = fitted(NormalPrior((1,), np.array([0.3]), np.array([sd])))
    H = X.T @ X + np.diag([0.0, 1.0 / sd**2])
    mean = np.linalg.solve(H, X.T @ MEASURED + np.array([0.0, 0.3 / sd**2]))
    # Limits count as a uniform distribution of variance span^2/12.
    C = np.linalg.inv(H + np.eye(2) * 12.0 / linear.SPAN**2)
    assert values == pytest.approx(mean, abs=1e-6)
    assert sds == pytest.approx(np.sqrt(np.diag(C)), rel=1e-6)


def test_tight_known_value_moves_the_other_parameter_along_the_regression() -> None:
    free, _ = fitted(NO_PRIOR)
    bound, _ = fitted(NormalPrior((1,), np.array([0.3]), np.array([1e-5])))
    C = np.linalg.inv(design().T @ design())
    moved = C[0, 1] / C[1, 1] * (0.3 - free[1])
    assert abs(moved) > 0.5 * np.sqrt(C[0, 0])
    assert bound - free == pytest.approx([moved, 0.3 - free[1]], abs=1e-5)


def test_search_is_narrowed_to_what_is_known_and_its_limits() -> None:
    described = study(known={"rho": {"value": 1200, "sd": 10}})
    problem = linear.base(linear.random_columns(3), MEASURED).likelihood.problem
    narrowed = within_known(described, problem)
    k = described.parameters["k"]
    assert narrowed.lower.tolist() == [1170.0, k.lower]
    assert narrowed.upper.tolist() == [1230.0, k.upper]


def test_misfit_that_an_effect_explains_no_longer_weighs_known_values() -> None:
    """The base misfits, so known values count for more; the right model takes them as stated."""
    found = linear.random_columns(6, "k_T", size=60.0)
    quantity = strength_of("k_T")[1]
    k = 0.3
    y = np.random.default_rng(1).standard_normal(linear.TOTAL) + k * found["k"]
    y = y + quantity.typical * linear.column_of(found, "k_T")
    known = NormalPrior((1,), np.array([k + 0.2]), np.array([0.1]))
    start = weighed(linear.fit(found, y, known=known))
    assert start.model.base.likelihood.prior.weight > 2.0
    end = search_effects(start, ["k_T"], 6, SearchContext(np.random.default_rng(1))).end
    assert end.effects == ("k_T",)
    assert end.model.base.likelihood.prior.weight == 1.0
    value, sd = (part[1] for part in values_of(end))
    assert abs(value - k) < 2.0 * sd
