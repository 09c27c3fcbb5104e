"""The types of numbers and truth values side by side, and the operators on them."""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typeconv import Conversion
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, lower_cast, models, register_model

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
