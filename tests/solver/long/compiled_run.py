"""Calls compiled functions in a process of its own; prints the results' bits and the compilations.

    python compiled_run.py one_tga eight_tga one_slab eight_slabs
    python compiled_run.py one_tga --turn FOLDER first      # the other process: second
    python compiled_run.py cells --nobody                   # without the rights of root
    python compiled_run.py cells --room 1000                # as on a disk with so many bytes left

With ``--turn`` two processes replace files in the order in which a cache without a lock mixes up
two signatures: both have read it, the second's first file comes last, then the first's second file.
"""

import argparse
import hashlib
import json
import os
import resource
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from pyrofit.config import Study, read_study
from pyrofit.model.accuracy import Accuracy
from pyrofit.simulate import lowered, simulate_gasifications, simulate_tgas
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.lower import Substance

SMOKE = Path(__file__).parents[3] / "config" / "smoke.yaml"
CALLS = {"cells": 1, "one_tga": 1, "eight_tga": 1, "one_slab": 2, "eight_slabs": 2}
"""How many signatures each needs; those of slabs need that of `cells`, too."""
LONGEST_S = 20.0


def bits(name: str) -> str:
    """Return the digest of the curves of one call, or the number of cells."""
    study = read_study(SMOKE)
    sets = 1 if name.startswith("one") else 8
    values = {n: np.full(sets, x) for n, x in study.true_values().items()}
    if name == "cells":
        experiment = study.experiments["slab_60"]
        case = lowered(experiment, Substance(study.material, study.true_values()), Accuracy())
        return str(case.cells)
    found = tga(study, values, sets) if "tga" in name else slab(study, values, sets)
    return hashlib.sha256(
        b"".join(curve.tobytes() for one in found for curve in one.signals.values())
    ).hexdigest()


def tga(study: Study, values: Any, sets: int) -> list[Curves]:
    """Return the curves of a heated sample."""
    T = np.linspace(450.0, 750.0, 31)
    asked = Request(T - 450.0, temperature_K=T)
    experiment = study.experiments["tga_20K"]
    return simulate_tgas([experiment], study.material, values, [asked], sets=sets)[0]


def slab(study: Study, values: Any, sets: int) -> list[Curves]:
    """Return the curves of a slab."""
    asked = {"mlr": Request(np.arange(5.0, 100.0, 5.0), 5.0)}
    experiment = study.experiments["slab_60"]
    return simulate_gasifications(experiment, study.material, values, asked, sets=sets)


def take_turns(folder: Path, which: str) -> None:
    """Let this process replace its files when it is its turn, or after some seconds."""
    order = {
        # Waits for these marks, by the number of the file; then it sets its own.
        "first": [["second ready"], ["second 1"]],
        "second": [["first 0"], ["first ready"]],
    }[which]
    replace: Callable[..., None] = os.replace
    count = iter(range(99))

    def in_turn(*given: Any, **named: Any) -> None:
        n = next(count)
        (folder / f"{which} ready").touch()
        give_up = time.monotonic() + LONGEST_S
        awaited = order[n] if n < len(order) else []
        while time.monotonic() < give_up and not all((folder / m).exists() for m in awaited):
            time.sleep(0.01)
        replace(*given, **named)
        (folder / f"{which} {n}").touch()

    os.replace = in_turn


def be_nobody() -> None:
    """Give up the rights of root; modules that are imported later may be unreadable then."""
    for name in ("grid", "slab", "tga"):
        import_module(f"pyrofit.solver.kernels.{name}")
    read_study(SMOKE)
    if os.getuid() == 0:
        os.setgid(65534)
        os.setuid(65534)


def compiled() -> dict[str, int]:
    """Return how many signatures of each function this process did not find on disk."""
    from pyrofit.solver.kernels import grid, slab, tga

    functions = (grid.cells_needed, slab.slab, slab.slabs, tga.tga)
    return {f.py_func.__name__: sum(f.stats.cache_misses.values()) for f in functions}


def main() -> None:
    """Call the functions that the command line names."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="+")
    parser.add_argument("--turn", nargs=2)
    parser.add_argument("--nobody", action="store_true")
    parser.add_argument("--room", type=int)
    given = parser.parse_args()
    if given.turn:
        take_turns(Path(given.turn[0]), given.turn[1])
    if given.nobody:
        be_nobody()
    if given.room is not None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (given.room, given.room))
    start = time.perf_counter()
    found = {name: bits(name) for name in given.names}
    took = time.perf_counter() - start
    print(json.dumps({"bits": found, "compiled": compiled(), "took_s": took}))


if __name__ == "__main__":
    main()
