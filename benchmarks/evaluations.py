"""The table of evaluations per second, and the values that it is compared with."""

import json
import os
import subprocess
import sys
from pathlib import Path

import cost
import peak
from case import FLUXES, Rates, error, rates, setup
from page import filed, table

from pyrofit.model.accuracy import Accuracy
from pyrofit.solver.run import LANES

HERE = Path(__file__).parent
SETTINGS = ("default", "0.2 %")
NEEDED = {  # On one core at an error of at most 0.2 %, whole evaluations.
    ("capa_25", "scalar"): 3000,
    ("capa_25", "lanes"): 20000,
    ("capa_60", "lanes"): 4000,
}
WORDS = {
    "load": "loads",
    "store": "stores",
    "mul": "multiplications",
    "fma": "fused multiply-adds",
    "add": "additions",
    "div": "divisions",
    "root": "roots",
    "sign": "changes of sign",
    "choose": "selections",
    "bits": "operations on the bits",
    "compare": "comparisons",
}
"""Names of the counted operations in the page."""
MANY = 256
"""Sets in a call, so many that work done once for all of them does not count."""


def setting(name: str, label: str) -> Accuracy:
    """Return the default setting, or the cheapest of 0.2 %."""
    return Accuracy() if label == "default" else cost.cheapest(name)


def operations(name: str) -> dict[str, float]:
    """Return the operations per cell and step, counted in a process without compiled code."""
    given = cost.cheapest(name).model_dump_json()
    done = subprocess.run(
        [sys.executable, str(HERE / "operations.py"), name, given],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        check=True,
        capture_output=True,
        text=True,
    )
    counted: dict[str, float] = json.loads(done.stdout)
    return counted


def evaluations() -> str:
    """Return evaluations per second and the share of the peak."""
    found = {(n, s): rates(setup(n), setting(n, s)) for n in FLUXES for s in SETTINGS}
    rows = []
    for (name, label), r in found.items():
        nearby = cost.errors_nearby(name, setting(name, label))
        rows.append(
            (
                FLUXES[name],
                label,
                r.cells,
                r.steps,
                f"{100 * error(name, setting(name, label)):.3f}",
                f"{100 * nearby[len(nearby) // 2]:.3f}, {100 * nearby[-1]:.3f}",
                *(f"{x:,.0f}" for x in r[:4]),
            )
        )
    head = (
        "kW/m²",
        "setting",
        "cells",
        "steps",
        "error %",
        "of sets nearby, median and worst %",
        "scalar 1/s",
        "lanes 1/s",
        "scalar kernel 1/s",
        "lanes kernel 1/s",
    )
    chosen = " ".join(
        f"At {FLUXES[n]} kW/m² it has cells {a.cells}, tolerance {a.tolerance:g}, first_step_s "
        f"{a.first_step_s:g}, longest_step_s {a.longest_step_s:g}."
        for n, a in ((n, cost.cheapest(n)) for n in FLUXES)
    )
    return (
        f"{table(head, rows)}\n\nThe setting *0.2 %* is the cheapest of a scan (cells times steps) "
        f"with an error of at most 0.2 % for the published set. {chosen} The error was also "
        f"computed for {cost.NEIGHBOURS} sets nearby, whose values differ by up to a tenth.\n\n"
        f"{needed(found)}\n\n{share_of_peak(found)}\n\n{peers()}"
    )


def needed(found: dict[tuple[str, str], Rates]) -> str:
    """Return the rates the project asks for, beside those measured at 0.2 %."""
    rows = []
    for (name, how), wanted in NEEDED.items():
        r = found[name, "0.2 %"]
        whole, kernel = (
            (r.scalar, r.kernel_scalar) if how == "scalar" else (r.lanes, r.kernel_lanes)
        )
        if how == "lanes":
            whole = max(whole, cost.rate(name, cost.cheapest(name), MANY))
        said = "yes" if whole >= wanted else "**no**"
        rows.append((FLUXES[name], how, f"{wanted:,}", f"{whole:,.0f}", said, f"{kernel:,.0f}"))
    head = ("kW/m²", "how", "wanted 1/s", "measured 1/s", "reached", "kernel alone 1/s")
    return (
        f"{table(head, rows)}\n\n*Wanted* is the aim set before the measurement. "
        f"The rate in lanes is the higher one of {LANES} and {MANY} equal sets in a call, with one "
        "thread."
    )


def share_of_peak(found: dict[tuple[str, str], Rates]) -> str:
    """Return the floating-point rate of the kernel beside that of a plain loop."""
    most, rows = peak.flops_per_second(), []
    for name in FLUXES:
        counted, r = operations(name), found[name, "0.2 %"]
        for how, rate in (("scalar", r.kernel_scalar), ("lanes", r.kernel_lanes)):
            flops = counted["flops"] * r.cells * r.steps * rate
            time = r.per_cell_step_ns(f"kernel_{how}")
            rows.append(
                (
                    FLUXES[name],
                    how,
                    f"{counted['flops']:.0f}",
                    f"{time:.2f}",
                    f"{flops / 1e9:.1f}",
                    f"{100 * flops / most:.0f} %",
                )
            )
    per = {words: counted["per"].get(name, 0.0) for name, words in WORDS.items()}
    used = [(words, f"{count:.0f}") for words, count in per.items() if count >= 0.5]
    words = f"Operations per cell and step at {FLUXES[name]} kW/m²"
    most_used = filed("operations", words, ("operation", "number"), used)
    head = ("kW/m²", "how", "flops per cell and step", "ns", "Gflop/s", "share of the plain loop")
    share = filed("share_of_peak", "Share of the plain loop", head, rows)
    return (
        f"A plain loop of fused multiply-adds in the same registers, twelve "
        f"independent chains, reaches {most / 1e9:.0f} Gflop/s on this core. To count "
        "operations, the kernels run uncompiled with numbers that record each operation "
        "(`benchmarks/operations.py`). Addition, multiplication, division and root count as one "
        "operation, a fused multiply-add as two. Minimum, maximum, comparison, selection, sign, "
        f"loads and stores take time but do not count. {most_used}; {share}."
    )


def peers() -> str:
    """Return the times of other solvers."""
    return (
        "Other solvers were timed once on another machine, for one evaluation at 25 kW/m². FDS "
        "6.7.4 in the paper's set-up (625 cells, 0.05 s steps) takes 9.6 CPU-s. Gpyro 0.82, with "
        "two of its bugs patched, takes 0.34 s at an error of 0.09 %. The comparison includes "
        "the difference of the machines."
    )
