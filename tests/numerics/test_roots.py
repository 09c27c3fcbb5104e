"""The whitening of common errors, against eigenvalues."""

import numpy as np
import pytest

from pyrofit.numerics.roots import whitening

SIZES = {
    "of one size": [1.0, 1.0, 1.0, 1.0],
    "large and small": [3e3, 2e2, 1.0, 1e-3],
    "dependent": [50.0, 0.0, 7.0, 0.0],
    "none": [0.0, 0.0, 0.0, 0.0],
}


@pytest.mark.parametrize("sizes", SIZES.values(), ids=SIZES)
@pytest.mark.parametrize("points", [1, 3, 4, 30])
def test_whitening_is_the_root_of_the_inverse(points: int, sizes: list[float]) -> None:
    rng = np.random.default_rng(points)
    mixed = np.linalg.qr(rng.standard_normal((4, 4)))[0]
    V = rng.standard_normal((points, 4)) / np.sqrt(points) * sizes @ mixed
    Q, s, _ = np.linalg.svd(V, full_matrices=False)
    exact = np.eye(points) - Q * (1.0 - 1.0 / np.sqrt(1.0 + s**2)) @ Q.T
    B, F = whitening(V)
    # The rounding of V^T V remains.
    error = np.max(np.abs(np.eye(points) - B @ F @ B.T - exact))
    assert error < 1e-14 + 2e-16 * s.max() ** 2
    assert np.max(np.abs(B)) <= 1.0
    assert np.max(np.abs(F)) <= 1.0


def test_many_common_errors_are_whitened() -> None:
    at = np.linspace(0.0, 1.0, 80)
    kernel = 1e6 * np.exp(-(((at[:, None] - at) / 0.2) ** 2))
    values, vectors = np.linalg.eigh(kernel)
    V = vectors * np.sqrt(np.maximum(values, 0.0))
    B, F = whitening(V)
    W = np.eye(80) - B @ F @ B.T
    assert np.allclose(W @ (np.eye(80) + V @ V.T) @ W, np.eye(80), atol=1e-7)
    assert np.array_equal(F, F.T)
