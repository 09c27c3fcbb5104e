"""The step of a reaction of order n against its closed form, alone and side by side."""

from decimal import Decimal, localcontext

import numpy as np
import pytest
from numba import njit

from pyrofit.solver.kernels.functions import power
from pyrofit.solver.kernels.lanes import in_lanes
from pyrofit.solver.kernels.reactions import order_factors


@njit(error_model="numpy")
def factors(width, u, x, n, out):
    u, x, n, to = in_lanes(width, u), in_lanes(width, x), in_lanes(width, n), in_lanes(width, out)
    for k in range(u.size):
        to[0, k], to[1, k] = order_factors(power(u[k], n[k] - 1.0), x[k], n[k])


draw = np.random.default_rng(11)
SIZE = 4096
LEFT = 10.0 ** draw.uniform(-9.0, 0.0, SIZE)
RATE = 10.0 ** draw.uniform(-9.0, 1.0, SIZE)
ORDER = np.where(draw.uniform(size=SIZE) < 0.1, 1.0, draw.uniform(0.3, 3.0, SIZE))


def found(width: int) -> np.ndarray:
    out = np.empty((2, SIZE // width, width))
    factors((0,) * width, *(a.reshape(-1, width) for a in (LEFT, RATE, ORDER)), out)
    return out.reshape(2, SIZE)


def closed_form(u: Decimal, x: Decimal, n: Decimal) -> Decimal:
    """Return u after the step, zero where nothing is left."""
    if n == 1:
        return u * (-x).exp()
    left = u ** (1 - n) - (1 - n) * x
    return left ** (1 / (1 - n)) if left > 0 else Decimal(0)


def test_factors_are_those_of_the_closed_form() -> None:
    with localcontext(prec=50):
        for *given, factor, behind in zip(LEFT, RATE, ORDER, *found(8), strict=True):
            u, x, n = map(Decimal, given)
            after = closed_form(u, x, n)
            if after == 0:
                assert factor * given[1] == pytest.approx(700.0)
                assert behind == 0.0
                continue
            assert factor * given[1] == pytest.approx(float((u / after).ln()), rel=1e-10)
            lost = float(after ** (1 - n) / u ** (1 - n))  # 1 - y, which rounding makes inexact
            assert behind == pytest.approx(float(after ** (n - 1)), rel=1e-12 + 1e-15 / lost)


def test_a_first_order_among_others_is_exactly_that() -> None:
    assert (found(8)[:, ORDER == 1.0] == 1.0).all()


@pytest.mark.parametrize("width", [8, 16])
def test_lanes_have_the_bits_of_a_set_alone(width: int) -> None:
    assert found(width).tobytes() == found(1).tobytes()
