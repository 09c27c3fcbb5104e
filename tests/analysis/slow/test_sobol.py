"""Sobol's indices: a function of known indices, failed runs, seeds."""

import numpy as np
import pytest
from scipy.stats import sobol_indices

from pyrofit.analysis import sobol


def ishigami(x: np.ndarray) -> np.ndarray:
    """Return Ishigami's function of points in the unit cube, and the sum of two coordinates."""
    z = np.pi * (2.0 * x - 1.0)
    y = np.sin(z[..., 0]) + 7.0 * np.sin(z[..., 1]) ** 2 + 0.1 * z[..., 2] ** 4 * np.sin(z[..., 0])
    return np.stack([y, 3.0 * x[..., 0] + 4.0 * x[..., 1], np.full(y.shape, 5.0)], axis=-1)


FIRST = [0.3139, 0.4424, 0.0]
TOTAL = [0.5576, 0.4424, 0.2437]
"""Ishigami and Homma (1990) with a = 7, b = 0.1."""


def found(count: int = 4096, seed: int = 3) -> sobol.Indices:
    return sobol.indices(ishigami(sobol.design(count, 3, seed)), seed)


def test_indices_of_ishigamis_function_lie_in_their_intervals() -> None:
    got = found()
    assert got.first[0] == pytest.approx(FIRST, abs=0.02)
    assert got.total[0] == pytest.approx(TOTAL, abs=0.02)
    assert np.all(got.first_low[0] < np.array(FIRST) + 1e-3)
    assert np.all(got.first_high[0] > np.array(FIRST) - 1e-3)
    assert np.all(got.total_low[0] < np.array(TOTAL) + 1e-3)
    assert np.all(got.total_high[0] > np.array(TOTAL) - 1e-3)


def test_sum_has_no_interaction_and_a_constant_no_index() -> None:
    got = found()
    assert got.first[1] == pytest.approx([0.36, 0.64, 0.0], abs=0.01)
    assert got.total[1] == pytest.approx([0.36, 0.64, 0.0], abs=0.01)
    assert np.isnan(got.total[2]).all()


def test_bootstrap_is_that_of_resampled_runs() -> None:
    y = ishigami(sobol.design(64, 3, 1))[..., :1]
    drawn = np.random.default_rng(5).integers(64, size=64)
    weights = np.bincount(drawn, minlength=64)[None] / 64
    runs = np.moveaxis(y, 0, -1)
    (first, _), (total, _) = sobol._intervals(runs - runs[:2].mean(), weights)
    again = runs[..., drawn] - runs[:2].mean()
    func = {"f_A": again[0], "f_B": again[1], "f_AB": again[2:]}
    # A resample is not centred anew, as in SciPy's own bootstrap.
    mine = 0.5 * np.mean((again[0] - again[2:]) ** 2, axis=-1)[:, 0] / np.var(again[:2])
    assert total[0] == pytest.approx(mine, rel=1e-9)
    assert total[0] == pytest.approx(sobol_indices(func=func, n=64).total_order, rel=1e-9)
    assert first.shape == (1, 3)


def test_equal_seeds_give_equal_bits_and_others_do_not() -> None:
    assert np.array_equal(found(64).total_high, found(64).total_high, equal_nan=True)
    assert not np.array_equal(sobol.design(8, 2, 1), sobol.design(8, 2, 2))


def test_intervals_narrow_with_the_sample() -> None:
    def width(count: int) -> float:
        got = found(count)
        return float(np.mean(got.total_high[0] - got.total_low[0]))

    assert width(4096) < 0.5 * width(256)


def test_base_points_with_a_failed_run_are_replaced_by_others() -> None:
    y = ishigami(sobol.design(256, 3, 1))
    y[[3, 77], 2] = np.nan
    whole, failed = sobol.replace_failed(y, 1)
    assert failed == 2
    assert np.isfinite(whole).all()
    assert sobol.indices(whole, 1).total[0] == pytest.approx(TOTAL, abs=0.15)
