"""Instructions of the kernel by processor and number of lanes, counted in compiled code.

Run: python benchmarks/instructions.py

Numba's code for slabs in lanes is translated for processors that need not be at hand. Counted are
vector operations of floating point numbers, and accesses of vector registers to the stack. These
are values that have no room in registers. The code is not run.
"""

import json
import os
import re
import subprocess
import sys
import tempfile

import llvmlite.binding as llvm
import numpy as np
from case import setup
from lanes import SETTINGS, SPREAD
from page import filed

from pyrofit.solver import run

LANES = (4, 8, 16)
CASE = "capa_25"
X86, ARM = "x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"
PROCESSORS = {
    "AVX-512": (X86, "skylake-avx512", 8),
    "AVX2": (X86, "haswell", 4),
    "NEON": (ARM, "neoverse-n1", 2),
}
"""Triple, processor, numbers in a register."""
_NO_X86 = re.compile(r"(%\S+ = )[a-z ]*call [^\n]*@llvm\.x86\.atomic\.sub\.cc\.i64\([^\n]*")
"""Numba's count of references; only the instruction that takes its place matters here."""
_VECTOR = {
    X86: r"v(add|sub|mul|div|fn?m|sqrt|max|min|cmp)\w*pd.*%[yz]mm",
    ARM: r"f\w+\s+v\d+\.2d",
}
_STACK = {
    X86: r"v?mov\S*\s.*\(%r[sb]p\).*%[yz]mm|v?mov\S*\s.*%[yz]mm\d+.*\(%r[sb]p\)",
    ARM: r"(ldr|ldur|str|stur|ldp|stp)\s+q.*\[(sp|x29)",
}


def intermediate(lanes: int) -> str:
    """Return numba's code for slabs with a number of lanes."""
    from pyrofit.solver.kernels.slab import slabs

    run.LANES = lanes
    of = setup(CASE)
    draw = np.random.default_rng(1).uniform(1.0 - SPREAD, 1.0 + SPREAD, (len(of.values), lanes))
    values = {n: x * d for (n, x), d in zip(of.values.items(), draw, strict=True)}
    of.run_sets(values, lanes, SETTINGS[CASE])
    (compiled,) = slabs.overloads.values()
    return str(compiled.library.get_llvm_str())


def assembly(code: str, triple: str, processor: str) -> list[str]:
    """Return the instructions of code for a processor."""
    target = llvm.Target.from_triple(triple)
    machine = target.create_target_machine(cpu=processor, opt=3, reloc="pic", codemodel="default")
    code = re.sub(r"target triple = .*", f'target triple = "{triple}"', code)
    code = re.sub(r"target datalayout = .*", f'target datalayout = "{machine.target_data}"', code)
    code = re.sub(r'"target-(cpu|features)"="[^"]*"', "", code)
    module = llvm.parse_assembly(_NO_X86.sub(r"\1add i8 0, 0", code))
    lines = (line.strip() for line in machine.emit_assembly(module).splitlines())
    return [line for line in lines if line and not line.startswith((".", "#", "//"))]


def counts(lines: list[str], triple: str) -> tuple[int, int]:
    """Return vector operations, and accesses of vector registers to the stack."""
    vector = sum(bool(re.match(_VECTOR[triple], line)) for line in lines)
    stack = [line for line in lines if re.match(_STACK[triple], line)]
    return vector, sum(2 if line.startswith(("ldp", "stp")) else 1 for line in stack)


def of_lanes(lanes: int) -> dict[str, tuple[int, int]]:
    """Return the counts by processor."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    code = intermediate(lanes)
    return {
        name: counts(assembly(code, triple, processor), triple)
        for name, (triple, processor, _) in PROCESSORS.items()
    }


def main() -> None:
    """Print the table, each number of lanes compiled in a process of its own."""
    if len(sys.argv) > 1:
        print(json.dumps(of_lanes(int(sys.argv[1]))))
        return
    rows = []
    for lanes in LANES:
        with tempfile.TemporaryDirectory() as folder:  # code that is kept cannot be looked at
            done = subprocess.run(
                [sys.executable, __file__, str(lanes)],
                env={**os.environ, "NUMBA_CACHE_DIR": folder},
                check=True,
                capture_output=True,
                text=True,
            )
        for name, (vector, stack) in json.loads(done.stdout.splitlines()[-1]).items():
            registers = lanes / PROCESSORS[name][2]
            rows.append([name, lanes, f"{registers:g}", f"{vector:,}", f"{stack / vector:.2f}"])
    rows.sort(key=lambda row: list(PROCESSORS).index(row[0]))
    heads = ("processor", "lanes", "registers of a value", "vector operations", "stack accesses")
    print(filed("instructions", "Table", (*heads[:4], f"{heads[4]} of an operation"), rows))


if __name__ == "__main__":
    main()
