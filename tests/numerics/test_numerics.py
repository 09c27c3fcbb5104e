"""Arithmetic with the same bits on every processor: exact cases, NumPy's results, singular ones."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import minimize

from pyrofit.numerics import bands, fitting, functions, linear
from pyrofit.solver.arrays import FloatArray

EPS = np.finfo(float).eps
ANOTHER = {
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL",
    "OPENBLAS_CORETYPE": "Nehalem",
}
"""Makes NumPy and OpenBLAS take the code of an old processor."""
SHAPES = [(1, 1), (4, 1), (5, 3), (3, 5), (40, 9), (1000, 30), (81, 83)]


def random(*shape: int, seed: int = 0) -> FloatArray:
    return np.random.default_rng(seed).standard_normal(shape)


def positive(n: int) -> FloatArray:
    a = random(n, n)
    return a @ a.T + np.eye(n)


# --- Functions --------------------------------------------------------------------------------


def worst(found: FloatArray, exact: FloatArray) -> float:
    """Return the largest error in units of the last place."""
    return float(np.max(np.abs((found - exact) / np.spacing(np.abs(exact).astype(float)))))


@pytest.mark.skipif(np.finfo(np.longdouble).nmant < 63, reason="no longer numbers here")
def test_functions_are_exact_to_a_unit_of_the_last_place() -> None:
    rng = np.random.default_rng(1)
    x = np.concatenate([rng.uniform(-700.0, 700.0, 20_000), rng.uniform(-1.0, 1.0, 20_000)])
    assert worst(functions.exp(x), np.exp(x.astype(np.longdouble))) < 1.0
    y = np.concatenate([np.exp(x[:20_000]), rng.uniform(0.5, 2.0, 20_000)])
    assert worst(functions.log(y), np.log(y.astype(np.longdouble))) < 1.0
    assert worst(functions.cube_root(y), np.cbrt(y.astype(np.longdouble))) < 1.0


def test_functions_of_numbers_without_an_end() -> None:
    assert functions.exp([0.0, -np.inf, np.inf, 800.0]).tolist() == [1.0, 0.0, np.inf, np.inf]
    assert functions.exp(-745.0) == 5e-324
    assert functions.log([1.0, 0.0, np.inf]).tolist() == [0.0, -np.inf, np.inf]
    assert np.isnan([functions.log(-1.0), functions.exp(np.nan), functions.log(np.nan)]).all()
    assert functions.log(5e-324) == math.log(5e-324)
    assert functions.cube_root([-8.0, 0.0, 27.0]).tolist() == [-2.0, 0.0, 3.0]
    assert functions.power([0.0, 4.0], [2.5, 0.5]).tolist() == [0.0, 2.0]
    assert functions.power(0.0, 0.0) == 1.0


def test_functions_near_and_far_from_zero() -> None:
    x = np.linspace(-60.0, 60.0, 5001)
    assert np.max(np.abs(functions.tanh(x) - np.tanh(x))) < 2.0 * EPS
    assert functions.log_one_plus_exp(x) == pytest.approx(np.logaddexp(0.0, x), rel=1e-14)
    assert functions.log_one_plus_exp(-700.0) > 0.0
    assert functions.power(1.7, x) == pytest.approx(1.7**x, rel=1e-14)


def test_function_of_a_number_is_that_of_an_array() -> None:
    x = np.concatenate([random(50), 200.0 * random(500), [-745.2, 709.79, 720.0, -np.inf]])
    assert [functions.exp(v) for v in x.tolist()] == functions.exp(x).tolist()
    y = np.concatenate([functions.exp(x), [5e-324]])
    assert [functions.log(v) for v in y.tolist()] == functions.log(y).tolist()
    assert functions.exp(x[:50].reshape(5, 10)).shape == (5, 10)


def test_geometric_has_one_ratio_and_exact_ends() -> None:
    found = functions.geometric(0.05, 700.0, 33)
    assert (found[0], found[-1]) == (0.05, 700.0)
    assert found[1:] / found[:-1] == pytest.approx((700.0 / 0.05) ** (1.0 / 32.0), rel=1e-13)


# --- Products and factors ---------------------------------------------------------------------


@pytest.mark.parametrize(
    ("one", "other"), [((3,), (3,)), ((4, 3), (3,)), ((3,), (3, 2)), ((4, 3), (3, 2))]
)
def test_product_is_that_of_matrices(one: tuple[int, ...], other: tuple[int, ...]) -> None:
    a, b = random(*one), random(*other, seed=1)
    assert linear.product(a, b) == pytest.approx(a @ b, rel=1e-14)
    assert linear.product(random(5, 4, 3), random(3)) == pytest.approx(random(5, 4, 3) @ random(3))
    with pytest.raises(ValueError, match="broadcast"):
        linear.product(a, np.ones(7))


LAYOUTS = {
    "rows": np.ascontiguousarray,
    "columns": np.asfortranarray,
    "part": lambda a: np.pad(a, 2)[2:-2, 2:-2],
    "reversed": lambda a: a[::-1, ::-1].copy()[::-1, ::-1],
}
"""Ways in which a matrix may lie in memory."""


@pytest.mark.parametrize("first", LAYOUTS)
@pytest.mark.parametrize("second", LAYOUTS)
@pytest.mark.parametrize(("m", "i", "n"), [(23, 41, 18), (1, 3000, 1), (3, 900, 1), (1, 90, 30)])
def test_large_product_has_the_sums_of_einsum(
    first: str, second: str, m: int, i: int, n: int
) -> None:
    a, b = LAYOUTS[first](random(m, i)), LAYOUTS[second](random(i, n, seed=1))
    found, expected = linear.product(a, b), np.einsum("ki,ij->kj", a, b)
    assert np.array_equal(found, expected)
    # The next sum depends on it.
    assert found.flags.f_contiguous == expected.flags.f_contiguous
    assert np.array_equal(linear.gram(b), np.einsum("ki,ij->kj", b.T, b))


def test_matrices_that_do_not_fit_have_no_product() -> None:
    with pytest.raises(ValueError, match="no product"):
        linear.product(random(40, 50), random(40, 30))


@pytest.mark.parametrize("n", [1, 2, 30, 200])
def test_cholesky_solves_and_inverts(n: int) -> None:
    a, b = positive(n), random(n, 3)
    left = linear.cholesky(a)
    assert np.array_equal(left, np.tril(left))
    assert np.max(np.abs(left @ left.T - a)) < 1e-13 * np.max(a)
    assert a @ linear.solve(a, b) == pytest.approx(b, abs=1e-9)
    assert a @ linear.solve(a, b[:, 0]) == pytest.approx(b[:, 0], abs=1e-9)
    assert linear.inverse(a) @ a == pytest.approx(np.eye(n), abs=1e-9)
    assert np.array_equal(linear.inverse(a), linear.inverse(a).T)
    assert linear.inverse_root(a) @ left == pytest.approx(np.eye(n), abs=1e-9)
    assert linear.log_det(a) == pytest.approx(np.linalg.slogdet(a)[1], rel=1e-12)
    assert left @ linear.solve_lower(left, b) == pytest.approx(b, abs=1e-10)
    assert left.T @ linear.solve_upper(left.T, b) == pytest.approx(b, abs=1e-10)


@pytest.mark.parametrize("a", [np.zeros((2, 2)), -np.eye(3), np.full((2, 2), np.nan)])
def test_matrix_that_is_not_positive_is_refused(a: FloatArray) -> None:
    for function in (linear.cholesky, linear.inverse, linear.log_det, linear.inverse_root):
        with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
            function(a)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("scaled", [False, True])
def test_orthogonal_factors_make_the_matrix_again(shape: tuple[int, int], scaled: bool) -> None:
    a = random(*shape) * (np.logspace(-9, 3, shape[1]) if scaled else 1.0)
    size, unit = np.max(np.abs(a)), np.eye(min(shape))
    Q, R = linear.qr(a)
    assert np.max(np.abs(Q @ R - a)) < 1e-14 * len(a) * size
    assert pytest.approx(unit, abs=1e-13) == Q.T @ Q
    assert np.array_equal(R, np.triu(R))
    U, s, rows = linear.svd(a)
    assert np.max(np.abs(U * s @ rows - a)) < 1e-13 * size
    assert pytest.approx(unit, abs=1e-12) == U.T @ U
    assert rows @ rows.T == pytest.approx(unit, abs=1e-12)
    assert np.all(np.diff(s) <= 0.0)
    assert np.max(np.abs(s - np.linalg.svd(a, compute_uv=False))) < 1e-13 * s[0]


def test_small_singular_values_of_scaled_columns_are_exact() -> None:
    # Orthogonal columns of very different length: their lengths are the singular values.
    sizes = np.logspace(-60, 60, 9)
    found = linear.svd(np.linalg.qr(random(50, 9))[0] * sizes)[1]
    assert found == pytest.approx(sizes[::-1], rel=1e-14)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("small", [1e-160, 1e-170, 1e-200, 1e-300])
def test_singular_values_of_columns_far_apart_in_size_give_no_warning(small: float) -> None:
    a = random(6, 3) * np.array([1.0, small, small])
    found = linear.svd(a)[1]
    assert found[0] == pytest.approx(np.linalg.norm(a[:, 0]))
    assert np.all(found[1:] <= 10.0 * small)


def test_singular_matrices_have_orthonormal_factors_and_the_shortest_solution() -> None:
    a, b = random(50, 6), random(50)
    a[:, 3], a[:, 5] = a[:, 1] + a[:, 2], 0.0
    U, s, rows = linear.svd(a)
    assert s[-2:] == pytest.approx([0.0, 0.0], abs=1e-14 * s[0])
    for factor in (U.T @ U, rows @ rows.T):
        assert factor == pytest.approx(np.eye(6), abs=1e-13)
    assert np.max(np.abs(U * s @ rows - a)) < 1e-14 * s[0]
    exact = np.linalg.lstsq(a, b, rcond=None)[0]
    assert linear.least_squares(a, b) == pytest.approx(exact, abs=1e-13)
    U, s, rows = linear.svd(np.zeros((4, 3)))
    assert s.tolist() == [0.0, 0.0, 0.0]
    assert np.array_equal(rows @ rows.T, np.eye(3))
    assert linear.qr(np.zeros((4, 2)))[1].tolist() == [[0.0, 0.0], [0.0, 0.0]]


@pytest.mark.parametrize("n", [1, 2, 7, 60])
def test_eigenvectors_of_a_symmetric_matrix(n: int) -> None:
    a = random(n, n)
    a = a + a.T
    values, vectors = linear.eigen(a)
    assert values == pytest.approx(np.linalg.eigvalsh(a), abs=1e-13 * n * np.max(np.abs(a)))
    assert vectors * values @ vectors.T == pytest.approx(a, abs=1e-12)


def test_thin_factor_of_a_smooth_covariance_has_few_columns() -> None:
    t = np.linspace(0.0, 1.0, 200)
    a = np.exp(-0.5 * ((t[:, None] - t) / 0.2) ** 2)
    factor = linear.thin_factor(np.diag(a), lambda k: a[k], 1e-10)
    assert factor.shape[1] < 25
    assert np.max(np.abs(factor @ factor.T - a)) < 1e-10
    assert linear.thin_factor(np.ones(3), lambda k: np.eye(3)[k], 1e-10).shape == (3, 3)


def test_correlation_is_that_of_numpy() -> None:
    rows = random(4, 30)
    assert linear.correlation(rows) == pytest.approx(np.corrcoef(rows), abs=1e-14)
    assert np.isnan(linear.correlation(np.ones((2, 5)))).all()


def test_polynomial_and_running_mean_are_those_of_numpy() -> None:
    x, y = np.linspace(300.0, 900.0, 40), random(40)
    found = fitting.polynomial(x, y, 2)
    assert np.polyval(found, x) == pytest.approx(np.polyval(np.polyfit(x, y, 2), x), abs=1e-10)
    for width in (1, 2, 5, 10):
        mean = np.convolve(y, np.full(width, 1.0 / width), mode="same")
        assert linear.running_mean(y, width) == pytest.approx(mean, abs=1e-14)


@pytest.mark.parametrize("lags", [(0.4,), (-0.2, -0.3), (0.1, 0.1, 0.1)])
def test_banded_factor_is_that_of_the_whole_matrix(lags: tuple[float, ...]) -> None:
    whole = scipy.linalg.toeplitz([1.0, *lags, *[0.0] * (39 - len(lags))])
    left, b = np.linalg.cholesky(whole), random(40, 3)
    factor = bands.cholesky(lags, 40)
    assert factor[:, 0] == pytest.approx(np.diag(left), rel=1e-14)
    exact = np.linalg.solve(left, b)
    assert bands.solve_lower(factor, b) == pytest.approx(exact, abs=1e-12)
    assert np.array_equal(bands.solve_lower(factor, b[:, 0]), bands.solve_lower(factor, b)[:, 0])
    with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
        bands.cholesky((0.9, *lags), 40)


# --- Fitting ----------------------------------------------------------------------------------


def test_descent_finds_the_bottom_of_a_bent_valley() -> None:
    def valley(x: FloatArray) -> FloatArray:
        return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]])

    assert fitting.least_squares(valley, np.array([-1.2, 1.0])) == pytest.approx([1.0, 1.0])


def test_nelder_and_mead_takes_the_way_of_scipy_and_ends_without_a_way() -> None:
    def valley(x: FloatArray) -> float:
        return float((1.0 - x[0]) ** 2 + 100.0 * (x[1] - x[0] ** 2) ** 2)

    simplex = np.array([[-1.0, 1.0], [-0.9, 1.0], [-1.0, 1.1]])
    options = {"initial_simplex": simplex, "xatol": 1e-6, "fatol": 1e-9}
    same = minimize(valley, simplex[0], method="Nelder-Mead", options=options).x
    assert fitting.nelder_mead(valley, simplex, 1e-6, 1e-9) == pytest.approx(same, abs=1e-12)
    assert fitting.nelder_mead(lambda x: np.inf, simplex, 0.01, 0.01).tolist() == [-1.0, 1.0]


# --- Bits -------------------------------------------------------------------------------------

ALL = """
import hashlib, numpy as np
from pyrofit.estimate.quadratic import least_within
from pyrofit.numerics import bands, fitting, functions as f, linear
rng = np.random.default_rng(0)
total = hashlib.sha256()
x = rng.uniform(-20.0, 20.0, 3001)
for of in (f.exp, f.tanh, f.cube_root, f.log_one_plus_exp):
    total.update(of(x).tobytes())
total.update(f.log(np.abs(x)).tobytes() + f.power(np.abs(x), 1.37).tobytes())
total.update(f.geometric(0.05, 700.0, 33).tobytes())
for rows, columns in ((7, 3), (300, 31), (60, 60)):
    a, b = rng.standard_normal((rows, columns)), rng.standard_normal(rows)
    square = linear.gram(a) + np.eye(columns)
    found = [*linear.qr(a), *linear.svd(a), *linear.eigen(square), linear.inverse(square)]
    thin = linear.thin_factor(np.diag(square), lambda k: square[k], 1e-9)
    found += [thin, linear.correlation(a.T), linear.product(b, a)]
    found += [linear.least_squares(a, b), fitting.polynomial(b, b**2 + a[:, 0], 2)]
    low, high = np.full(columns, -0.01), np.full(columns, 0.02)
    found += [least_within(square, linear.product(a.T, b), low, high)]
    found += [bands.solve_lower(bands.cholesky((0.3, -0.2), rows), a)]
    for part in found:
        total.update(np.ascontiguousarray(part).tobytes())
print(total.hexdigest())
"""


def test_results_have_the_bits_of_another_processor() -> None:
    def bits(**features: str) -> str:
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", ALL],
            env={**os.environ, **features},
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.strip()

    assert bits(**ANOTHER) == bits()
