"""Elementary functions of numbers, and tables, the same to the last bit in every lane."""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import signature
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

from pyrofit.compiled.jit import inner
from pyrofit.solver.kernels.lane_types import Lanes, splat
from pyrofit.solver.kernels.lanes import number_like

_BITS = ir.IntType(64)
_DOUBLE = ir.DoubleType()


def _bits(kind: Any) -> Any:
    return ir.VectorType(_BITS, kind.count) if isinstance(kind, Lanes) else _BITS


def _constant(kind: Any, value: int) -> Any:
    shape = _bits(kind)
    return ir.Constant(shape, [value] * kind.count if isinstance(kind, Lanes) else value)


@intrinsic
def root(typing: Any, x: Any) -> Any:
    """Return the square root, correctly rounded."""
    kind = number_like(x)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        (value,) = args
        name = f"llvm.sqrt.v{kind.count}f64" if isinstance(kind, Lanes) else "llvm.sqrt.f64"
        function = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(value.type, [value.type]), name
        )
        return builder.call(function, [value])

    return signature(kind, kind), build


@intrinsic
def fma(typing: Any, a: Any, b: Any, c: Any) -> Any:
    """Return a b + c, rounded once."""
    kind = number_like(a, b, c)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        value = args[0].type
        name = f"llvm.fma.v{kind.count}f64" if isinstance(kind, Lanes) else "llvm.fma.f64"
        function = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(value, 3 * [value]), name
        )
        return builder.call(function, args)

    return signature(kind, kind, kind, kind), build


@intrinsic
def _roughly_inverse(typing: Any, x: Any) -> Any:
    """Return 1/x to 5 %: the exponent changed in sign, the mantissa by a straight line."""
    kind = number_like(x)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        bits = builder.bitcast(args[0], _bits(kind))
        flipped = builder.sub(_constant(kind, 0x7FDE623822FC16E6), bits)
        return builder.bitcast(flipped, context.get_value_type(kind))

    return signature(kind, kind), build


@inner
def nearly_inverse(x):
    """Return 1/x to 3e-12, for a normal x above zero and below 1e300.

    Twice y (1 + e + e^2) with e = 1 - x y, which is of third order; a division takes longer.
    """
    y = _roughly_inverse(x)
    for _ in range(2):
        e = fma(-x, y, 1.0)
        y = fma(y, fma(e, e, e), y)
    return y


ROUNDING = 6755399441055744.0
"""1.5 * 2^52: added to a number, it leaves the nearest integer in the last bits."""
_ROUNDING_BITS = 0x4338000000000000


@intrinsic
def power_of_two(typing: Any, rounded: Any) -> Any:
    """Return 2^n for n + `ROUNDING`, n an integer from -1022 to 1023."""
    kind = number_like(rounded)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        bits = builder.bitcast(args[0], _bits(kind))
        exponent = builder.add(bits, _constant(kind, 1023 - _ROUNDING_BITS))
        shifted = builder.shl(exponent, _constant(kind, 52))
        return builder.bitcast(shifted, context.get_value_type(kind))

    return signature(kind, kind), build


@intrinsic
def binary_exponent(typing: Any, x: Any) -> Any:
    """Return n of x = f 2^n with f from sqrt(1/2) to sqrt(2), for a normal x above zero."""
    kind = number_like(x)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        bits = builder.bitcast(args[0], _bits(kind))
        moved = builder.add(bits, _constant(kind, 0x95F619980C433))
        exponent = builder.lshr(moved, _constant(kind, 52))
        as_float = builder.or_(exponent, _constant(kind, 0x4330000000000000))
        number = builder.bitcast(as_float, context.get_value_type(kind))
        offset = context.get_constant(types.float64, 2.0**52 + 1023.0)
        if isinstance(kind, Lanes):
            offset = splat(builder, offset, kind.count)
        return builder.fsub(number, offset)

    return signature(kind, kind), build


@inner
def exp(x):
    """Return e^x to 1e-13, for x from -700 to 700, and the ends beyond.

    x = n ln 2 + r with |r| <= ln(2)/2; the series of e^r is cut after r^11.
    """
    x = min(max(x, -700.0), 700.0)
    rounded = fma(x, 1.4426950408889634, ROUNDING)
    n = rounded - ROUNDING
    r = fma(-n, 1.90821492927058770002e-10, fma(-n, 0.693147180369123816490, x))
    p = fma(r, 1.0 / 39916800.0, 1.0 / 3628800.0)
    p = fma(r, p, 1.0 / 362880.0)
    p = fma(r, p, 1.0 / 40320.0)
    p = fma(r, p, 1.0 / 5040.0)
    p = fma(r, p, 1.0 / 720.0)
    p = fma(r, p, 1.0 / 120.0)
    p = fma(r, p, 1.0 / 24.0)
    p = fma(r, p, 1.0 / 6.0)
    p = fma(r, p, 0.5)
    p = fma(r, p, 1.0)
    return fma(r, p, 1.0) * power_of_two(rounded)


@inner
def exp_of_negative(x):
    """Return e^-x to 3e-10, for x from 0 to 700, and the end beyond; for rates of reactions.

    As `exp`, with the series cut after r^8, and ln 2 as one number.
    """
    rounded = fma(min(x, 700.0), -1.4426950408889634, ROUNDING)
    n = rounded - ROUNDING
    r = fma(n, -0.6931471805599453, -min(x, 700.0))
    p = fma(r, 1.0 / 40320.0, 1.0 / 5040.0)
    p = fma(r, p, 1.0 / 720.0)
    p = fma(r, p, 1.0 / 120.0)
    p = fma(r, p, 1.0 / 24.0)
    p = fma(r, p, 1.0 / 6.0)
    p = fma(r, p, 0.5)
    p = fma(r, p, 1.0)
    return fma(r, p, 1.0) * power_of_two(rounded)


@inner
def log(x):
    """Return ln x to 1e-14, for a normal x above zero and below 1e307.

    x = f 2^n; ln f = 2 artanh(s), s = (f - 1)/(f + 1), whose series is cut after s^19.
    """
    n = binary_exponent(x)
    f = x * power_of_two(ROUNDING - n)
    s = (f - 1.0) / (f + 1.0)
    q = s * s
    p = 1.0 / 11.0 + q * (1.0 / 13.0 + q * (1.0 / 15.0 + q * (1.0 / 17.0 + q * (1.0 / 19.0))))
    p = 1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q * p)))
    return n * 0.6931471805599453 + 2.0 * (s + s * q * p)


@inner
def power(x, n):
    """Return x^n for a normal x above zero."""
    return exp(n * log(x))


@intrinsic
def whole(typing: Any, x: Any) -> Any:
    """Return the part of x before the point, as a number."""
    kind = number_like(x)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        counts = ir.IntType(32)
        if isinstance(kind, Lanes):
            counts = ir.VectorType(counts, kind.count)
        return builder.sitofp(builder.fptosi(args[0], counts), args[0].type)

    return signature(kind, kind), build


@intrinsic
def at_node(typing: Any, table: Any, i: Any, node: Any) -> Any:
    """Return table[i, node], lane by lane where the node has lanes, of its own row or lane.

    One load per lane: the processor's own instruction for that takes longer. The places count from
    the row's begin, so that they are found once for all tables.
    """
    kind = number_like(node)
    if isinstance(kind, Lanes) and table.layout != "C":
        return None

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        held = make_array(table)(context, builder, args[0])
        of_row, of_node = cgutils.unpack_tuple(builder, held.strides, 2)
        row = builder.add(builder.ptrtoint(held.data, _BITS), builder.mul(args[1], of_row))
        if not isinstance(kind, Lanes):
            at = builder.add(row, builder.mul(builder.fptosi(args[2], _BITS), of_node))
            return builder.load(builder.inttoptr(at, _DOUBLE.as_pointer()), align=8)
        count = kind.count
        own = isinstance(table.dtype, Lanes)
        places = ir.VectorType(_BITS, count)
        size = ir.Constant(places, [8 * count if own else 8] * count)
        at = builder.mul(builder.fptosi(args[2], places), size)
        found = ir.Constant(ir.VectorType(_DOUBLE, count), ir.Undefined)
        for k in range(count):
            lane = ir.Constant(ir.IntType(32), k)
            begin = builder.add(row, ir.Constant(_BITS, 8 * k if own else 0))
            place = builder.add(begin, builder.extract_element(at, lane))
            number = builder.load(builder.inttoptr(place, _DOUBLE.as_pointer()), align=8)
            found = builder.insert_element(found, number, lane)
        return found

    return signature(kind, table, types.int64, kind), build
