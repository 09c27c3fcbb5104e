"""Numbers of several parameter sets side by side, one to a lane of the processor's registers.

The kernels are written for numbers. Compiled for one set these are plain floats; for more they are
`Lanes`, on which arithmetic acts lane by lane. No operation mixes lanes, none is contracted or
reordered, and none is the C library's: a set has the same result to the last bit in any lane,
beside any neighbours. Where a branch would depend on a number, both sides are computed and `where`
chooses.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.imputils import impl_ret_borrowed
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import (
    intrinsic,
    lower_builtin,
    lower_cast,
    models,
    register_model,
)
from numba.np.arrayobj import make_array, populate_array

_DOUBLE = ir.DoubleType()


class Lanes(types.Type):
    """A number for each of several parameter sets."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(name=f"Lanes({count})")

    def unify(self, context: Any, other: Any) -> Any:
        """Return the type that a variable has which is once this and once that."""
        return self if isinstance(other, types.Float | types.Integer) else None

    def can_convert_from(self, context: Any, other: Any) -> Any:
        """Tell that a plain number stands for the same one in every lane."""
        return Conversion.safe if isinstance(other, types.Float | types.Integer) else None


class Mask(types.Type):
    """A truth value for each of several parameter sets."""

    def __init__(self, count: int) -> None:
        self.count = count
        super().__init__(name=f"Mask({count})")

    def unify(self, context: Any, other: Any) -> Any:
        """Return the type that a variable has which is once this and once that."""
        return self if isinstance(other, types.Boolean) else None

    def can_convert_from(self, context: Any, other: Any) -> Any:
        """Tell that a plain truth value stands for the same one in every lane."""
        return Conversion.safe if isinstance(other, types.Boolean) else None


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, of: Lanes) -> None:
        super().__init__(dmm, of, ir.VectorType(_DOUBLE, of.count))


@register_model(Mask)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, of: Mask) -> None:
        super().__init__(dmm, of, ir.VectorType(ir.IntType(1), of.count))


def splat(builder: Any, value: Any, count: int) -> Any:
    """Return a vector with the same value in every lane."""
    vector = ir.Constant(ir.VectorType(value.type, count), ir.Undefined)
    for lane in range(count):
        vector = builder.insert_element(vector, value, ir.Constant(ir.IntType(32), lane))
    return vector


@lower_cast(types.Float, Lanes)
@lower_cast(types.Integer, Lanes)
def _number_to_lanes(context: Any, builder: Any, given: Any, wanted: Any, value: Any) -> Any:
    number = context.cast(builder, value, given, types.float64)
    return splat(builder, number, wanted.count)


@lower_cast(types.Boolean, Mask)
def _truth_to_mask(context: Any, builder: Any, given: Any, wanted: Any, value: Any) -> Any:
    return splat(builder, context.cast(builder, value, given, types.boolean), wanted.count)


def _operation(
    symbol: Any, given: type, gives: type, arity: int, build: Callable[..., Any]
) -> None:
    """Let an operator or builtin act on lanes."""

    class Typed(AbstractTemplate):
        def generic(self, args: Any, kws: Any) -> Any:
            """Return the types of a call, where some argument has lanes."""
            found = [a for a in args if isinstance(a, given)]
            if len(args) != arity or not found or kws:
                return None
            return signature(gives(found[0].count), *arity * [found[0]])

    Typed.key = symbol
    infer_global(symbol)(Typed)

    @lower_builtin(symbol, *arity * [given])
    def _(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return build(builder, *args)


def _choose(compare: str) -> Callable[..., Any]:
    def build(builder: Any, a: Any, b: Any) -> Any:
        return builder.select(builder.fcmp_ordered(compare, b, a), b, a)

    return build


def _compare(how: str) -> Callable[..., Any]:
    return lambda builder, a, b: builder.fcmp_ordered(how, a, b)


def _unordered_differ(builder: Any, a: Any, b: Any) -> Any:
    return builder.fcmp_unordered("!=", a, b)


def _absolute(builder: Any, a: Any) -> Any:
    function = cgutils.get_or_insert_function(
        builder.module, ir.FunctionType(a.type, [a.type]), f"llvm.fabs.v{a.type.count}f64"
    )
    return builder.call(function, [a])


for _symbols, _name in (
    ((operator.add, operator.iadd), "fadd"),
    ((operator.sub, operator.isub), "fsub"),
    ((operator.mul, operator.imul), "fmul"),
    ((operator.truediv, operator.itruediv), "fdiv"),
):
    for _symbol in _symbols:
        _operation(_symbol, Lanes, Lanes, 2, lambda b, x, y, name=_name: getattr(b, name)(x, y))
_operation(operator.neg, Lanes, Lanes, 1, lambda builder, a: builder.fneg(a))
_operation(abs, Lanes, Lanes, 1, _absolute)
_operation(min, Lanes, Lanes, 2, _choose("<"))
_operation(max, Lanes, Lanes, 2, _choose(">"))
for _symbol, _how in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
):
    _operation(_symbol, Lanes, Mask, 2, _compare(_how))
_operation(operator.ne, Lanes, Mask, 2, _unordered_differ)
_operation(operator.and_, Mask, Mask, 2, lambda builder, a, b: builder.and_(a, b))
_operation(operator.or_, Mask, Mask, 2, lambda builder, a, b: builder.or_(a, b))


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
