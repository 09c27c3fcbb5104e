"""Numbers of several parameter sets side by side, one to a lane of the processor's registers.

The kernels are written for numbers. Compiled for one set these are plain floats; for more they are
`Lanes`, on which arithmetic acts lane by lane. No operation mixes lanes, none is contracted or
reordered, and none is the C library's. So a set has the same result to the last bit in any lane,
beside any neighbours. Where a branch would depend on a number, both sides are computed and `where`
chooses.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing.templates import signature
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

from pyrofit.solver.kernels.lane_types import Lanes, Mask


def number_like(*given: Any) -> Any:
    """Return the type that numbers of these types have together."""
    return next((g for g in given if isinstance(g, Lanes)), types.float64)


@intrinsic
def where(typing: Any, condition: Any, a: Any, b: Any) -> Any:
    """Return a where the condition holds, b elsewhere, lane by lane."""
    if isinstance(condition, Mask):
        kind: Any = Lanes(condition.count)
        if all(isinstance(x, Mask | types.Boolean) for x in (a, b)):
            kind = Mask(condition.count)
    else:
        kind = number_like(a, b)
        if all(isinstance(x, types.Boolean) for x in (a, b)):
            kind = types.boolean
        condition = types.boolean

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.select(*args)

    return signature(kind, condition, kind, kind), build


@intrinsic
def opposite(typing: Any, condition: Any) -> Any:
    """Return whether the condition does not hold, lane by lane."""
    if not isinstance(condition, Mask | types.Boolean):
        return None

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.not_(args[0])

    return signature(condition, condition), build


@intrinsic
def somewhere(typing: Any, condition: Any) -> Any:
    """Tell whether the condition holds in some lane."""
    if not isinstance(condition, Mask | types.Boolean):
        return None

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if isinstance(condition, types.Boolean):
            return args[0]
        as_bits = builder.bitcast(args[0], ir.IntType(condition.count))
        return builder.icmp_unsigned("!=", as_bits, ir.Constant(as_bits.type, 0))

    return signature(types.boolean, condition), build


@intrinsic
def in_lane(typing: Any, x: Any, lane: Any) -> Any:
    """Return the number in one lane."""
    kind = number_like(x)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if not isinstance(kind, Lanes):
            return args[0]
        return builder.extract_element(args[0], args[1])

    return signature(types.float64, kind, types.int64), build


@intrinsic
def with_lane(typing: Any, x: Any, lane: Any, value: Any) -> Any:
    """Return the numbers with another one in one lane."""
    kind = number_like(x)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if not isinstance(kind, Lanes):
            return args[2]
        return builder.insert_element(args[0], args[2], args[1])

    return signature(kind, kind, types.int64, types.float64), build


@intrinsic
def in_lanes(typing: Any, width: Any, array: Any) -> Any:
    """Return an array whose last axis is the lanes as one of numbers, of one axis less.

    ``width`` is a tuple with one entry per lane: its length is known when the code is compiled. The
    result is a view; of an array of one axis it is the number itself.
    """
    if not isinstance(array, types.Array) or (array.layout, array.dtype) != ("C", types.float64):
        return None
    number = types.float64 if len(width) == 1 else Lanes(len(width))
    kind = number
    if array.ndim > 1:
        kind = types.Array(number, array.ndim - 1, "C", aligned=False)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        given = make_array(array)(context, builder, args[1])
        content = context.get_value_type(number)
        data = builder.bitcast(given.data, content.as_pointer())
        if array.ndim == 1:
            return builder.load(data, align=8)
        shape = cgutils.unpack_tuple(builder, given.shape, array.ndim)[:-1]
        strides = cgutils.unpack_tuple(builder, given.strides, array.ndim)[:-1]
        view = make_array(kind)(context, builder)
        populate_array(
            view,
            data=data,
            shape=shape,
            strides=strides,
            itemsize=context.get_constant(types.intp, 8 * len(width)),
            meminfo=given.meminfo,
            parent=given.parent,
        )
        return impl_ret_borrowed(context, builder, kind, view._getvalue())

    return signature(kind, width, array), build
