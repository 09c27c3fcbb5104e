"""What is known of parameters, in the diagnosis of linear models: the answers are Gauss's."""

import linear
import numpy as np
import pytest
from small import study

from pyrofit.diagnose.intervals import values_of
from pyrofit.estimate.prior import NormalPrior, within_known
from pyrofit.solver.arrays import FloatArray

MEASURED = np.random.default_rng(8).standard_normal(linear.TOTAL)


def design(columns: linear.Columns) -> FloatArray:
    return np.column_stack([columns[name] for name in linear.NAMES])


@pytest.mark.parametrize("sd", [1.0, 0.1, 0.01])
def test_interval_is_that_of_the_normal_posterior(sd: float) -> None:
    columns = linear.random_columns(3)
    X = design(columns)
    known = NormalPrior((1,), np.array([0.3]), np.array([sd]))
    trial = linear.fit(columns, MEASURED, known=known)
    H = X.T @ X + np.diag([0.0, 1.0 / sd**2])
    mean = np.linalg.solve(H, X.T @ MEASURED + np.array([0.0, 0.3 / sd**2]))
    # Limits count as a uniform distribution of variance span^2/12.
    C = np.linalg.inv(H + np.eye(2) * 12.0 / linear.SPAN**2)
    values, sds = values_of(trial)
    assert values == pytest.approx(mean, abs=2e-3 * np.sqrt(C.diagonal().min()))
    assert sds == pytest.approx(np.sqrt(np.diag(C)), rel=1e-6)


def test_tight_known_value_moves_the_other_parameter_along_the_regression() -> None:
    columns = linear.random_columns(3)
    free, _ = values_of(linear.fit(columns, MEASURED))
    known = NormalPrior((1,), np.array([0.3]), np.array([1e-5]))
    bound, _ = values_of(linear.fit(columns, MEASURED, known=known))
    C = np.linalg.inv(design(columns).T @ design(columns))
    assert bound[1] == pytest.approx(0.3, abs=1e-5)
    assert bound[0] - free[0] == pytest.approx(C[0, 1] / C[1, 1] * (0.3 - free[1]), rel=1e-3)


def test_search_is_narrowed_to_what_is_known_and_its_limits() -> None:
    described = study(known={"rho": {"value": 1200, "sd": 10}})
    problem = linear.base(linear.random_columns(3), MEASURED).likelihood.problem
    narrowed = within_known(described, problem)
    k = described.parameters["k"]
    assert narrowed.lower.tolist() == [1170.0, k.lower]
    assert narrowed.upper.tolist() == [1230.0, k.upper]
