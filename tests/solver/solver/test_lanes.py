"""Numbers side by side: every operation acts in each lane as on a plain number, to the last bit."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from numba import njit

from pyrofit.solver.arrays import TABLE_SIZE, TABLE_TEMPERATURES_K
from pyrofit.solver.kernels.functions import (
    exp,
    exp_of_negative,
    fma,
    log,
    nearly_inverse,
    power,
    root,
)
from pyrofit.solver.kernels.lanes import in_lane, in_lanes, opposite, somewhere, where, with_lane
from pyrofit.solver.kernels.tables import at_temperature

WIDTHS = (8, 16)
Curve = np.ndarray[tuple[int], np.dtype[np.float64]]
compiled = njit(error_model="numpy")

SPECIAL = [0.0, -0.0, 1.0, -1.0, 0.5, 3.0, np.inf, -np.inf, np.nan, 5e-324, -2.2e-308, 1.7e308]


@compiled
def arithmetic(width, a, b, c, out):
    x, y, z = in_lanes(width, a), in_lanes(width, b), in_lanes(width, c)
    to = in_lanes(width, out)
    for n in range(x.size):
        to[0, n] = x[n] + y[n]
        to[1, n] = x[n] - y[n]
        to[2, n] = x[n] * y[n]
        to[3, n] = x[n] / y[n]
        to[4, n] = -x[n]
        to[5, n] = abs(x[n])
        to[6, n] = min(x[n], y[n])
        to[7, n] = max(x[n], y[n])
        to[8, n] = root(x[n])
        to[9, n] = fma(x[n], y[n], z[n])
        in_place = x[n]
        in_place += y[n]
        in_place -= z[n]
        in_place *= y[n]
        in_place /= z[n]
        to[10, n] = in_place
        to[11, n] = min(max(1.0, x[n]), 2) - 3 * y[n]


@compiled
def comparison(width, a, b, c, out):
    x, y, z = in_lanes(width, a), in_lanes(width, b), in_lanes(width, c)
    to = in_lanes(width, out)
    for n in range(x.size):
        to[0, n] = where(x[n] < y[n], 1.0, 0.0)
        to[1, n] = where(x[n] <= y[n], 1.0, 0.0)
        to[2, n] = where(x[n] > y[n], 1.0, 0.0)
        to[3, n] = where(x[n] >= y[n], 1.0, 0.0)
        to[4, n] = where(x[n] == y[n], 1.0, 0.0)
        to[5, n] = where(x[n] != y[n], 1.0, 0.0)
        to[6, n] = where((x[n] < y[n]) & (y[n] < z[n]), 1.0, 0.0)
        to[7, n] = where((x[n] < y[n]) | (y[n] < z[n]), 1.0, 0.0)
        to[8, n] = where(opposite(x[n] < y[n]), 1.0, 0.0)
        to[9, n] = where(x[n] < y[n], x[n], y[n])
        to[10, n] = where(where(x[n] < 0.0, y[n] < 0.0, z[n] < 0.0), 1.0, 0.0)
        to[11, n] = where(x.size > 0, x[n], y[n])
        to[12, n] = where(x.size == 0, x[n], y[n])


@compiled
def functions(width, a, b, c, out):
    x, y, _ = in_lanes(width, a), in_lanes(width, b), in_lanes(width, c)
    to = in_lanes(width, out)
    for n in range(x.size):
        to[0, n] = exp(x[n])
        to[1, n] = log(x[n])
        to[2, n] = power(x[n], y[n])
        to[3, n] = exp_of_negative(x[n])
        to[4, n] = nearly_inverse(x[n])


@compiled
def single_lanes(width, a, out):
    x, to = in_lanes(width, a), in_lanes(width, out)
    for n in range(x.size):
        turned = x[n]
        for lane in range(len(width)):
            opposite_lane = len(width) - 1 - lane
            turned = with_lane(turned, lane, in_lane(x[n], opposite_lane))
        to[n] = turned


@compiled
def above(width, a, limit, some):
    x = in_lanes(width, a)
    for n in range(x.size):
        some[n] = somewhere(x[n] > limit)


@compiled
def of_table(width, wide, table, a, out):
    rows, T, to = in_lanes(width, table), in_lanes(wide, a), in_lanes(wide, out)
    for n in range(T.size):
        to[0, n] = at_temperature(rows, 0, T[n])
        to[1, n] = at_temperature(rows, 1, T[n])


def apply(kernel: Callable[..., Any], rows: int, width: int, *given: Curve) -> Any:
    """Return what the kernel makes of numbers, shape (rows, numbers), with so many side by side."""
    out = np.full((rows, given[0].size // width, width), np.nan)
    kernel((0,) * width, *(x.reshape(-1, width) for x in given), out)
    return out.reshape(rows, -1)


def assert_same_bits(one: Any, other: Any) -> None:
    """Of what is no number sign and payload do not count."""
    neither = np.isnan(one) & np.isnan(other)
    differ = (one.view(np.int64) != other.view(np.int64)) & ~neither
    assert not differ.any(), np.argwhere(differ)[:5]


@cache
def numbers() -> tuple[Curve, Curve, Curve]:
    """All triples of special numbers, and random ones of all sizes; a multiple of 16 of them."""
    x, y, z = (part.ravel() for part in np.meshgrid(SPECIAL, SPECIAL, SPECIAL))
    draw = np.random.default_rng(8)
    some = draw.normal(size=(3, 4096 - x.size)) * 10.0 ** draw.uniform(-5, 5, (3, 4096 - x.size))
    some[:, ::7] *= 10.0 ** draw.uniform(-300, 300, some[:, ::7].shape)
    some[:, ::11] = some[0, ::11]
    a, b, c = (np.concatenate(pair) for pair in zip((x, y, z), some, strict=True))
    return a, b, c


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize(("kernel", "rows"), [(arithmetic, 12), (comparison, 13), (functions, 5)])
def test_operation_in_a_lane_has_the_bits_of_the_plain_number(
    kernel: Callable[..., Any], rows: int, width: int
) -> None:
    assert_same_bits(apply(kernel, rows, width, *numbers()), apply(kernel, rows, 1, *numbers()))


@pytest.mark.parametrize("kernel", [arithmetic, comparison, functions])
def test_result_does_not_depend_on_lane_or_neighbours(kernel: Callable[..., Any]) -> None:
    order = np.random.default_rng(3).permutation(numbers()[0].size)
    shuffled = tuple(x[order] for x in numbers())
    found = apply(kernel, 13, 8, *shuffled)
    assert_same_bits(found, apply(kernel, 13, 8, *numbers())[:, order])


def test_arithmetic_is_that_of_numpy_to_the_last_bit() -> None:
    x, y, z = numbers()
    found = apply(arithmetic, 12, 8, x, y, z)
    with np.errstate(all="ignore"):
        expected = [
            x + y,
            x - y,
            x * y,
            x / y,
            -x,
            np.abs(x),
            np.where(y < x, y, x),
            np.where(y > x, y, x),
            np.sqrt(x),
        ]
        in_place = (x + y - z) * y / z
        mixed = np.where(x > 1.0, x, 1.0)
        mixed = np.where(mixed > 2.0, 2.0, mixed) - 3.0 * y
    assert_same_bits(found[:9], np.array(expected))
    assert_same_bits(found[10:], np.array([in_place, mixed]))


def test_product_and_sum_are_rounded_once() -> None:
    # (1 + u)(1 - u) - 1 = -u^2 is lost where the product is rounded on its own.
    u = 2.0 ** -np.arange(27.0, 43.0)
    found = apply(arithmetic, 12, 8, 1.0 + u, 1.0 - u, np.full(16, -1.0))
    assert found[9].tolist() == (-u * u).tolist()


def test_comparison_is_that_of_numpy() -> None:
    x, y, z = numbers()
    expected = [
        x < y,
        x <= y,
        x > y,
        x >= y,
        x == y,
        x != y,
        (x < y) & (y < z),
        (x < y) | (y < z),
        ~(x < y),
    ]
    found = apply(comparison, 13, 8, x, y, z)
    assert found[:9].tolist() == np.array(expected, dtype=float).tolist()
    assert_same_bits(found[9], np.where(x < y, x, y))
    assert found[10].tolist() == np.where(x < 0.0, y < 0.0, z < 0.0).astype(float).tolist()
    assert_same_bits(found[11:], np.array([x, y]))


def of(row: int, x: Curve, y: Curve | None = None) -> Curve:
    """Return one of the functions at any number of places."""
    filled = -(-x.size // 8) * 8
    parts = [np.resize(part, filled) for part in (x, x if y is None else y)]
    found: Curve = apply(functions, 5, 8, *parts, parts[0])[row, : x.size]
    return found


def error(found: Curve, exact: Any) -> float:
    """Largest relative error against numbers of more digits."""
    return float(np.max(np.abs(found.astype(np.longdouble) / exact - 1.0)))


def longer(x: Curve) -> Any:
    return x.astype(np.longdouble)


ALL_SIZES = 10.0 ** np.linspace(-307.6, 307.7, 100_000)
NEAR_ONE = 1.0 + np.concatenate([s * 10.0 ** np.linspace(-15.5, -0.31, 20_000) for s in (1, -1)])


def test_exp_keeps_its_error() -> None:
    # Measured: 8.8e-15.
    x = np.concatenate([np.linspace(-700.0, 700.0, 200_001), np.linspace(-1.0, 1.0, 20_001)])
    assert error(of(0, x), np.exp(longer(x))) <= 1e-13


def test_exp_ends_where_it_says() -> None:
    x = np.array([0.0, -0.0, 1e3, np.inf, -1e3, -np.inf, np.nan, 700.0, -700.0])
    found = of(0, x)
    assert found[:2].tolist() == [1.0, 1.0]
    assert (found[2:4] == found[7]).all()
    assert (found[4:6] == found[8]).all()
    assert np.isnan(found[6])


def test_log_keeps_its_error() -> None:
    # Measured: 3e-16 of all sizes, 4e-16 near one.
    for x in (ALL_SIZES, NEAR_ONE):
        assert error(of(1, x), np.log(longer(x))) <= 1e-14
    assert of(1, np.ones(1)).tolist() == [0.0]


def test_power_keeps_the_error_of_its_exponential() -> None:
    # Rounding n ln x, at most 700, costs 700 2^-53 = 0.8e-13, ln x as much. Measured: 2.1e-13, and
    # 1e-14 for what reactions ask.
    draw = np.random.default_rng(4)
    x = 10.0 ** draw.uniform(-300.0, 300.0, 100_000)
    n = draw.uniform(-700.0, 700.0, x.size) / np.maximum(np.abs(np.log(x)), 1.0)
    assert error(of(2, x, n), longer(x) ** longer(n)) <= 3e-13
    reaction = draw.uniform(1e-12, 1.0, 100_000)
    orders = draw.uniform(-1.0, 4.0, reaction.size)
    assert error(of(2, reaction, orders), longer(reaction) ** longer(orders)) <= 3e-14


def test_power_zero_and_the_powers_of_one_are_one() -> None:
    x = ALL_SIZES[::100]
    assert (of(2, x, np.zeros(x.size)) == 1.0).all()
    assert (of(2, np.ones(x.size), np.linspace(-9.0, 9.0, x.size)) == 1.0).all()


def test_inverse_keeps_its_error() -> None:
    # Measured: 2.1e-12.
    x = np.concatenate([ALL_SIZES[ALL_SIZES < 1e300], np.linspace(1.0, 2.0, 100_001)])
    assert error(of(4, x), 1.0 / longer(x)) <= 3e-12


def test_short_exponential_keeps_its_error() -> None:
    # The first term left out, (ln(2)/2)^9/9!, is 2.0e-10.
    x = np.linspace(0.0, 690.0, 100_001)
    assert error(of(3, x), np.exp(-longer(x))) <= 3e-10
    assert of(3, np.array([0.0, 1e9, np.inf])).tolist()[0] == 1.0
    assert (of(3, np.array([800.0, 1e9, np.inf])) < 1e-300).all()


@pytest.mark.parametrize("width", WIDTHS)
def test_single_lanes_are_read_and_written(width: int) -> None:
    given = np.arange(4.0 * width)
    out = np.empty((4, width))
    single_lanes((0,) * width, given.reshape(4, width), out)
    assert out.tolist() == given.reshape(4, width)[:, ::-1].tolist()


@pytest.mark.parametrize("width", [1, *WIDTHS])
def test_somewhere_finds_a_single_lane(width: int) -> None:
    given = np.vstack([np.eye(width), np.zeros(width), np.full(width, np.nan), np.ones(width)])
    some = np.empty(len(given), dtype=np.bool_)
    above((0,) * width, given, 0.5, some)
    assert some.tolist() == [*width * [True], False, False, True]


@pytest.mark.parametrize("width", [1, *WIDTHS])
def test_property_is_read_from_the_table_of_its_own_lane(width: int) -> None:
    draw = np.random.default_rng(5)
    tables = draw.uniform(0.1, 0.4, (2, TABLE_SIZE, width))
    T = draw.uniform(100.0, 1700.0, (64, width))
    T[:4] = TABLE_TEMPERATURES_K[[0, 1, -2, -1], None]
    T[4:8] = np.array([-1e300, 1e300, np.inf, np.nan])[:, None]
    out = np.empty((2, 64, width))
    of_table((0,) * width, (0,) * width, tables, T, out)
    T[7] = TABLE_TEMPERATURES_K[0]
    for i in range(2):
        for lane in range(width):
            expected = np.interp(T[:, lane], TABLE_TEMPERATURES_K, tables[i, :, lane])
            assert out[i, :, lane] == pytest.approx(expected, rel=1e-13)
    alone = np.empty((2, 64, 1))
    for lane in range(width):
        one = np.ascontiguousarray(tables[:, :, lane : lane + 1])
        of_table((0,), (0,), one, np.ascontiguousarray(T[:, lane : lane + 1]), alone)
        assert_same_bits(out[:, :, lane : lane + 1].copy(), alone)


@pytest.mark.parametrize("wide", WIDTHS)
def test_cells_side_by_side_read_the_one_table_there_is(wide: int) -> None:
    draw = np.random.default_rng(7)
    table, T = draw.uniform(0.1, 0.4, (2, TABLE_SIZE, 1)), draw.uniform(100.0, 1700.0, (64, wide))
    together, alone = np.empty((2, 64, wide)), np.empty((2, 64 * wide, 1))
    of_table((0,), (0,) * wide, table, T, together)
    of_table((0,), (0,), table, T.reshape(-1, 1), alone)
    assert_same_bits(together.reshape(alone.shape), alone)


@pytest.mark.parametrize("width", [1, *WIDTHS])
def test_constant_property_is_that_of_its_lane(width: int) -> None:
    tables = np.random.default_rng(6).uniform(0.1, 0.4, (2, 1, width))
    T = np.full((3, width), [[1.0], [300.0], [1e9]])
    out = np.empty((2, 3, width))
    of_table((0,) * width, (0,) * width, tables, T, out)
    assert np.array_equal(out, np.broadcast_to(tables, out.shape))
