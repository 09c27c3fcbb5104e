"""Floating-point operations of a run, counted by running the kernels with numbers that count.

Run: NUMBA_DISABLE_JIT=1 python benchmarks/operations.py    prints JSON
"""

import json
import math
import os
import struct
import sys
from collections import Counter
from typing import Any

os.environ["NUMBA_DISABLE_JIT"] = "1"

import numpy as np

from pyrofit.solver.kernels import functions, jit, lanes

COUNTS: Counter[str] = Counter()


class Counted(float):
    """A number that counts the operations on it."""


def _noting(name: str, function: Any) -> Any:
    def noted(*given: Any) -> Any:
        COUNTS[name] += 1
        found = function(*(float(x) for x in given))
        return Counted(found) if isinstance(found, float) else found

    return noted


for _names, _noted, _of in (
    (("add", "radd", "sub", "rsub"), "add", float),
    (("mul", "rmul"), "mul", float),
    (("neg", "abs"), "sign", float),
    (("lt", "le", "gt", "ge", "eq", "ne"), "compare", float),
):
    for _name in _names:
        setattr(Counted, f"__{_name}__", _noting(_noted, getattr(_of, f"__{_name}__")))


def _divide(a: float, b: float) -> float:
    return a / b if b else (math.nan if a == 0.0 or a != a else math.copysign(math.inf, a))


Counted.__truediv__ = _noting("div", _divide)
Counted.__rtruediv__ = _noting("div", lambda b, a: _divide(a, b))
Counted.__hash__ = float.__hash__


class View:
    """An array whose elements count, and that counts loads and stores."""

    def __init__(self, of: Any) -> None:
        self.of, self.shape, self.size = of, of.shape, of.size

    def __getitem__(self, at: Any) -> Any:
        found = self.of[at]
        if isinstance(found, np.ndarray):
            return View(found)
        COUNTS["load"] += 1
        return Counted(found)

    def __setitem__(self, at: Any, value: Any) -> None:
        COUNTS["store"] += 1
        self.of[at] = float(value)


def _in_lanes(width: tuple[int, ...], array: Any) -> Any:
    return Counted(array[0]) if array.ndim == 1 else View(array[..., 0])


def _power_of_two(rounded: float) -> float:
    return math.ldexp(1.0, int(rounded - functions.ROUNDING))


def _binary_exponent(x: float) -> float:
    f, n = math.frexp(x)
    return float(n - (f < math.sqrt(0.5)))


def _roughly_inverse(x: float) -> float:
    bits = 0x7FDE623822FC16E6 - struct.unpack("q", struct.pack("d", x))[0]
    return struct.unpack("d", struct.pack("q", bits))[0]


def _where(condition: Any, a: Any, b: Any) -> Any:
    COUNTS["choose"] += 1
    chosen = a if condition else b
    return chosen if isinstance(chosen, bool | np.bool_) else Counted(chosen)


def _least(*given: Any) -> Any:
    COUNTS["choose"] += any(isinstance(x, Counted) for x in given)
    return sorted(given, key=float)[0]


def _most(*given: Any) -> Any:
    COUNTS["choose"] += any(isinstance(x, Counted) for x in given)
    return sorted(given, key=float)[-1]


PLAIN = {
    "where": _where,
    "opposite": lambda condition: not condition,
    "somewhere": bool,
    "root": _noting("root", math.sqrt),
    "fma": _noting("fma", lambda a, b, c: a * b + c),
    "_roughly_inverse": _noting("bits", _roughly_inverse),
    "power_of_two": _noting("bits", _power_of_two),
    "binary_exponent": _noting("bits", _binary_exponent),
    "in_lane": lambda x, lane: x,
    "with_lane": lambda x, lane, value: Counted(value),
    "in_lanes": _in_lanes,
    "whole": _noting("bits", lambda x: float(int(x))),
    "at_node": lambda table, i, node: table[i, int(node)],
}
FLOPS = {"fma": 2, "add": 1, "mul": 1, "div": 1, "root": 1}


def replace_intrinsics() -> None:
    """Give the kernels plain functions in place of the compiled ones."""
    for name, function in PLAIN.items():
        for module in (lanes, functions):
            if hasattr(module, name):
                setattr(module, name, function)
    jit.live.__globals__["np"] = np


def main() -> None:
    """Run the set-up once with one set, and print the operations per cell and step."""
    replace_intrinsics()
    from case import kernel_arguments, setup

    from pyrofit.model.accuracy import Accuracy
    from pyrofit.solver.kernels import slab, trace

    for module in [m for n, m in sys.modules.items() if n.startswith("pyrofit.solver.kernels.")]:
        module.min, module.max = _least, _most
    name, accuracy = sys.argv[1], Accuracy(**json.loads(sys.argv[2]))
    given = kernel_arguments(setup(name), accuracy, 1)
    cells = accuracy.cells
    _, outcome = slab.slab((0,), (0,), *given[2:])
    steps = int(outcome[0, trace.STEPS])
    per = {name: n / (steps * cells) for name, n in COUNTS.items()}
    flops = sum(FLOPS.get(name, 0) * n for name, n in per.items())
    print(json.dumps({"steps": steps, "cells": cells, "per": per, "flops": flops}))


if __name__ == "__main__":
    main()
