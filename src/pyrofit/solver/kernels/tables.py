"""Properties that follow the temperature by a table, for numbers or lanes of them."""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import signature
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

from pyrofit.solver.arrays import TABLE_SIZE, TABLE_START_K, TABLE_STEP_K
from pyrofit.solver.kernels.functions import fma
from pyrofit.solver.kernels.jit import inner
from pyrofit.solver.kernels.lanes import Lanes, number_like, splat

TABLE_END_K = TABLE_START_K + TABLE_STEP_K * (TABLE_SIZE - 1)
_PLACE = ir.IntType(64)
_DOUBLE = ir.DoubleType()


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
    """Return table[i, node], lane by lane where the node has lanes, of its own row or lane."""
    kind = number_like(node)

    def build(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        held = make_array(table)(context, builder, args[0])
        of_row, of_node = cgutils.unpack_tuple(builder, held.strides, 2)
        row = builder.add(builder.ptrtoint(held.data, _PLACE), builder.mul(args[1], of_row))
        if not isinstance(kind, Lanes):
            at = builder.mul(builder.fptosi(args[2], _PLACE), of_node)
            place = builder.inttoptr(builder.add(row, at), _DOUBLE.as_pointer())
            return builder.load(place, align=8)
        count = kind.count
        places = ir.VectorType(_PLACE, count)
        at = builder.mul(builder.fptosi(args[2], places), splat(builder, of_node, count))
        at = builder.add(splat(builder, row, count), at)
        if isinstance(table.dtype, Lanes):
            at = builder.add(at, ir.Constant(places, [8 * lane for lane in range(count)]))
        return _gathered(builder, at, count)

    return signature(kind, table, types.int64, kind), build


def _gathered(builder: Any, places: Any, count: int) -> Any:
    """Return the numbers that lie at several places of the memory."""
    numbers = ir.VectorType(_DOUBLE, count)
    truths = ir.VectorType(ir.IntType(1), count)
    pointers = builder.inttoptr(places, ir.VectorType(_DOUBLE.as_pointer(), count))
    every, rest = ir.Constant(truths, [1] * count), ir.Constant(numbers, ir.Undefined)
    align = ir.Constant(ir.IntType(32), 8)
    kind = ir.FunctionType(numbers, [pointers.type, align.type, truths, numbers])
    name = f"llvm.masked.gather.v{count}f64.v{count}p0"
    gather = cgutils.get_or_insert_function(builder.module, kind, name)
    return builder.call(gather, [pointers, align, every, rest])


@inner
def at_temperature(table, i, T):
    """Return property i at T, linear between the table's nodes; one node = constant."""
    if table.shape[1] == 1:
        return table[i, 0] + 0.0 * T
    x = (min(max(TABLE_START_K, T), TABLE_END_K) - TABLE_START_K) * (1.0 / TABLE_STEP_K)
    node = min(whole(x), TABLE_SIZE - 2.0)
    low = at_node(table, i, node)
    return fma(x - node, at_node(table, i, node + 1.0) - low, low)
