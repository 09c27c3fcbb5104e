"""Elementary functions of arrays and numbers, the same to the last bit on every processor.

The formulas of exp and log are those of fdlibm (Sun Microsystems 1993), in additions, products and
divisions that are rounded one by one. Results are off by less than two units in the last place,
where nothing else is said.
"""

import math
from collections.abc import Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Number = float | np.floating[Any]
Given = Floats | Sequence[Any]

_LN2 = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""ln 2 in two parts: an integer of 11 bits times the first is exact."""
_EXP = (
    1.66666666666666019037e-01,
    -2.77777777770155933842e-03,
    6.61375632143793436117e-05,
    -1.65339022054652515390e-06,
    4.13813679705723846039e-08,
)
_LOG = (
    6.666666666666735130e-01,
    3.999999999940941908e-01,
    2.857142874366239149e-01,
    2.222219843214978396e-01,
    1.818357216161805012e-01,
    1.531383769920937332e-01,
    1.479819860511658591e-01,
)


@overload
def exp(x: Number) -> float: ...
@overload
def exp(x: Given) -> Floats: ...
def exp(x: Any) -> Any:
    """Return e^x; inf beyond the largest number, 0 below the least one.

    x = k ln 2 + r, |r| <= ln(2)/2; e^r = 1 + r + r c/(2 - c) with a polynomial c of r.
    """
    if isinstance(x, float):
        return np.float64(_exp(float(x)))
    x = np.clip(np.asarray(x, dtype=np.float64), -800.0, 800.0)
    k = np.rint(x * 1.44269504088896338700)
    high, low = x - k * _LN2[0], k * _LN2[1]
    r = high - low
    c = r - (r * r) * _polynomial(_EXP, r * r)
    near = 1.0 - ((low - (r * c) / (2.0 - c)) - high)
    with np.errstate(over="ignore", under="ignore"):
        return np.ldexp(near, np.where(np.isnan(k), 0.0, k).astype(np.int32))


@overload
def log(x: Number) -> float: ...
@overload
def log(x: Given) -> Floats: ...
def log(x: Any) -> Any:
    """Return ln x; -inf of 0, nan of a negative number.

    x = 2^k (1 + f), sqrt(1/2) <= 1 + f < sqrt(2); ln(1 + f) = 2 artanh(s), s = f/(2 + f).
    """
    if isinstance(x, float):
        return np.float64(_log(float(x)))
    x = np.asarray(x, dtype=np.float64)
    usual = (x > 0.0) & (x < np.inf)
    part, k = np.frexp(np.where(usual, x, 1.0))
    low = part < 0.70710678118654752440
    f = np.where(low, 2.0 * part, part) - 1.0
    k = k - 1.0 * low
    s, half = f / (2.0 + f), 0.5 * f * f
    rest = (s * s) * _polynomial(_LOG, s * s)
    found = k * _LN2[0] - ((half - (s * (half + rest) + k * _LN2[1])) - f)
    if not np.all(usual):
        other = np.where(x == 0.0, -np.inf, np.where(x > 0.0, x, np.nan))
        found = np.where(usual, found, other)
    return found[()]


def _polynomial(coefficients: Sequence[float], x: Any) -> Any:
    total: Any = coefficients[-1]
    for c in reversed(coefficients[:-1]):
        total = c + x * total
    return total


def _exp(x: float) -> float:
    """Return e^x of a number, in the same operations: arrays of one take ten times as long."""
    if math.isnan(x):
        return x
    x = min(max(x, -800.0), 800.0)
    k = round(x * 1.44269504088896338700)
    high, low = x - k * _LN2[0], k * _LN2[1]
    r = high - low
    c: float = r - (r * r) * _polynomial(_EXP, r * r)
    near = 1.0 - ((low - (r * c) / (2.0 - c)) - high)
    return math.ldexp(near, k) if k < 1024 else math.ldexp(near, 1023) * math.ldexp(1.0, k - 1023)


def _log(x: float) -> float:
    """Return ln x of a number, in the same operations."""
    if not 0.0 < x < math.inf:
        return x if x > 0.0 else -math.inf if x == 0.0 else math.nan
    part, k = math.frexp(x)
    if part < 0.70710678118654752440:
        part, k = 2.0 * part, k - 1
    f = part - 1.0
    s, half = f / (2.0 + f), 0.5 * f * f
    rest: float = (s * s) * _polynomial(_LOG, s * s)
    return k * _LN2[0] - ((half - (s * (half + rest) + k * _LN2[1])) - f)


@overload
def power(x: Number, n: Number) -> float: ...
@overload
def power(x: Given, n: Any) -> Floats: ...
@overload
def power(x: Number, n: Given) -> Floats: ...
def power(x: Any, n: Any) -> Any:
    """Return x^n for x > 0, and 0^n = 0 for n > 0, as e^(n ln x).

    Its relative error is 2e-16 (2 + |n ln x|).
    """
    with np.errstate(invalid="ignore"):
        return exp(np.where(np.asarray(n) == 0.0, 0.0, np.asarray(n) * log(x)))


@overload
def fourth_power(x: Number) -> float: ...
@overload
def fourth_power(x: Given) -> Floats: ...
def fourth_power(x: Any) -> Any:
    """Return x^4 as a square of the square."""
    return (x * x) * (x * x)


@overload
def cube_root(x: Number) -> float: ...
@overload
def cube_root(x: Given) -> Floats: ...
def cube_root(x: Any) -> Any:
    """Return the real cube root: e^(ln|x|/3) and one step of Newton."""
    x = np.asarray(x, dtype=np.float64)
    size = np.abs(x)
    root = exp(log(np.where(size > 0.0, size, 1.0)) / 3.0)
    root = root - (root - np.where(size > 0.0, size, 1.0) / (root * root)) / 3.0
    return np.where(size > 0.0, np.copysign(root, x), 0.0)[()]


@overload
def tanh(x: Number) -> float: ...
@overload
def tanh(x: Given) -> Floats: ...
def tanh(x: Any) -> Any:
    """Return tanh x = (1 - u)/(1 + u) of |x|, u = e^(-2 |x|), to 2e-16 of one."""
    x = np.asarray(x, dtype=np.float64)
    u = exp(-2.0 * np.abs(x))
    return np.copysign((1.0 - u) / (1.0 + u), x)


@overload
def log_one_plus_exp(x: Number) -> float: ...
@overload
def log_one_plus_exp(x: Given) -> Floats: ...
def log_one_plus_exp(x: Any) -> Any:
    """Return ln(1 + e^x), without overflow.

    ln(1 + u) = ln(v) u/(v - 1) with v = 1 + u rounded is exact for small u, too (Kahan).
    """
    x = np.asarray(x, dtype=np.float64)
    u = exp(-np.abs(x))
    v = 1.0 + u
    small = np.where(v > 1.0, log(v) * (u / np.where(v > 1.0, v - 1.0, 1.0)), u)
    return np.maximum(x, 0.0) + small


def geometric(first: float, last: float, count: int) -> Floats:
    """Return numbers from the first to the last with one ratio, both ends exact, shape (count,).

    >>> geometric(1.0, 100.0, 3).round(12).tolist()
    [1.0, 10.0, 100.0]
    """
    found = exp(np.linspace(log(first), log(last), count))
    found[0], found[-1] = first, last
    return found
