"""Evaluations per second of the slab solver at measured error, and their dependences.

Run: python benchmarks/speed.py [SECTION ...]    writes docs/benchmarks.md and its figure
"""

import datetime
import os
import platform
import sys
from pathlib import Path

import campaign
import cost
import lanes
import scaling
import startup
from case import FINE, FLUXES, error, exact, relative_error, setup
from chart import draw
from evaluations import SETTINGS, evaluations, setting
from page import filed, put_section, table

from pyrofit.solver.run import LANES

GPYRO = (1 / 0.34, 9e-4)
"""Evaluations per second, and error; measured on another machine."""


def processor() -> str:
    """Return the model of the processor."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def machine() -> None:
    """Write the section on machine and method."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    put_section(
        "Machine and method",
        f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}, "
        f"{datetime.datetime.now(tz=datetime.UTC).date()}; load {load:.1f} before the start.\n\n"
        "The case is `config/paper.yaml` with the kinetics of Table 3 and the published set of the "
        "RMSE cost. The output is the mass loss rate in bins of 5 s. An evaluation is a call of "
        f"`simulate_gasification`, or of `simulate_gasifications` with {LANES} equal sets, with "
        "lowering and sampling. *Scalar* simulates one parameter set, *lanes* simulate "
        f"{LANES} side by side on one core; *kernel* is the compiled code alone. A timing is the "
        "shortest of many repeats in a second or more (in the curve half a second), on one core. "
        "The error is the root mean square difference of the bins over their mean. The reference "
        "is a solution of the same solver with "
        f"{FINE.cells} cells and a tolerance of {FINE.tolerance:g}.\n\n"
        + table(
            ("fine solution", "its difference from half its cells, four times its tolerance"),
            [(cost.words(name), f"{100 * fine_error(name):.4f} %") for name in FLUXES],
        ),
    )


def fine_error(name: str) -> float:
    """Return how much the fine solution changes with its own resolution."""
    half = FINE.model_copy(update={"cells": 400, "tolerance": 2e-4, "longest_step_s": 2.0})
    return relative_error(setup(name).run(half)[0].signals["mlr"], exact(name))


def curves() -> None:
    """Measure error against cost, and draw it."""
    points = {name: cost.curve(name) for name in FLUXES}
    marked = {}
    for name in FLUXES:
        marked[name] = {}
        for label in SETTINGS:
            off = error(name, setting(name, label))
            for how, sets in (("lanes", LANES), ("scalar", 1)):
                marked[name][f"{label}, {how}"] = cost.rate(name, setting(name, label), sets), off
    draw(points, marked, {"Gpyro, another machine": GPYRO})
    parts = []
    for name, of in points.items():
        rows = [
            (p.cells, f"{p.tolerance:g}", f"{100 * p.error:.3f}", f"{p.rate:,.0f}")
            for p in cost.front(of)
        ]
        head = ("cells", "tolerance", "error %", "lanes 1/s")
        parts.append(filed(f"error_against_cost_{name}", cost.words(name), head, rows))
    put_section(
        "Error against cost",
        "![error against evaluations per second](figures/benchmarks.svg)\n\n"
        "`python benchmarks/speed.py curves` measures and draws it.\n\n"
        "Settings for which no other one of the grid is both faster and more accurate. Rates are "
        "whole evaluations in lanes (first step 30 s times the tolerance, longest step 40 s):\n\n"
        + "; ".join(parts)
        + ".",
    )


def scales(*wanted: str) -> None:
    """Measure how the time scales with cells, sets, threads, reactions and effects."""
    name = "capa_25"
    cheap = cost.cheapest(name)
    tables = {
        "Cells": lambda: scaling.of_cells(name),
        "Sets": lambda: scaling.of_sets(name, cheap),
        "Threads": lambda: scaling.of_threads(name, cheap),
        "Reactions": lambda: scaling.of_reactions(name),
        "Effects": lambda: "; ".join(scaling.of_effects(n) for n in FLUXES),
    }
    for title in wanted or tables:
        put_section(f"Scaling: {title.lower()}", f"{scaling.NOTES[title]}\n\n{tables[title]()}.")


def starts() -> None:
    """Measure the time spent beside the solver."""
    put_section("Start-up", f"{startup.first_calls()}\n\n{startup.NOTE}\n\n{startup.job()}")


SECTIONS = {
    "machine": machine,
    "evaluations": lambda: put_section("Evaluations per second", evaluations()),
    "curves": curves,
    "cells": lambda: scales("Cells", "Reactions"),
    "sets": lambda: scales("Sets", "Threads"),
    "lanes": lambda: put_section("Scaling: lanes", lanes.measured()),
    "effects": lambda: scales("Effects"),
    "startup": starts,
    "campaign": lambda: put_section("The campaign", campaign.campaign()),
}


def main() -> None:
    """Measure the sections asked for, or all."""
    for section in sys.argv[1:] or SECTIONS:
        SECTIONS[section]()


if __name__ == "__main__":
    main()
