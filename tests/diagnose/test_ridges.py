"""What the data determine of an effect whose parameters they leave open."""

import numpy as np
import pytest

from pyrofit.diagnose.judge.ridges import ridge_of
from pyrofit.diagnose.settings import Settings

NAMES = ("yield", "density_kg_m3", "conductivity_W_mK")
VALUES = np.array([0.1, 300.0, 0.05])
LEAST = Settings().open_sd, Settings().ridge_gain


def covariance(powers: tuple[float, ...], known: float, each: float = 0.5) -> np.ndarray:
    """Return the covariance if a product of powers is known, each parameter by itself hardly."""
    a = np.array(powers)
    R = np.linalg.inv(np.eye(len(a)) / each**2 + np.outer(a, a) / known**2)
    return np.asarray(R * np.outer(VALUES[: len(a)], VALUES[: len(a)]))


def test_resistance_of_a_layer_is_determined_where_its_parts_are_not() -> None:
    found = ridge_of("char_layer", NAMES, VALUES, covariance((1.0, -1.0, -1.0), 0.02), *LEAST)
    assert found is not None
    assert found.exponents == {"yield": 1.0, "density_kg_m3": -1.0, "conductivity_W_mK": -1.0}
    assert found.relative_sd == pytest.approx(0.02, rel=0.01)
    assert found.alone["yield"] == pytest.approx(0.5 * np.sqrt(2.0 / 3.0), rel=0.01)


def test_parameter_that_the_product_leaves_out_is_not_named() -> None:
    found = ridge_of("char_layer", NAMES, VALUES, covariance((1.0, -2.0, 0.0), 0.01), *LEAST)
    assert found is not None
    assert found.exponents == {"yield": 1.0, "density_kg_m3": -2.0}


@pytest.mark.parametrize(
    ("known", "each"),
    [
        (0.02, 0.1),  # each one is known well enough
        (0.2, 0.5),  # the product is hardly better known than its factors
    ],
)
def test_no_ridge_where_parameters_are_known_or_nothing_is(known: float, each: float) -> None:
    assert each < LEAST[0] or known > each / LEAST[1]
    found = covariance((1.0, -1.0, -1.0), known, each)
    assert ridge_of("char_layer", NAMES, VALUES, found, *LEAST) is None


def test_one_parameter_and_negative_ones_have_no_ridge() -> None:
    wide = covariance((1.0, -1.0, -1.0), 0.02)
    assert ridge_of("char_layer", NAMES[:1], VALUES[:1], wide[:1, :1], *LEAST) is None
    assert ridge_of("char_layer", NAMES[:2], np.array([-0.1, 300.0]), wide[:2, :2], *LEAST) is None
