"""A million random parameter sets through the slab solver, many at a time.

Every set is drawn within the limits of a study and of one effect of the catalogue, at 25 or at
60 kW/m2. Looked for: a batch that does not end, a run that did not finish, a finished run with a
value that is no number, and heat or mass that is not accounted for.

Run:  python benchmarks/robustness.py FOLDER [--sets 1000000]    stop it at will; it resumes
      python benchmarks/robustness.py FOLDER --page              counts into docs/benchmarks.md
"""

import argparse
import json
import multiprocessing
import time
from collections import Counter
from multiprocessing.pool import Pool
from pathlib import Path
from typing import Any

import numpy as np
from boxes import BATCH, DURATION_S, SEED, cases, described
from page import put_section
from robustness_report import page, summed

from pyrofit.simulate import simulate_gasifications
from pyrofit.solver.curves import Curves, Request

LIMIT_S = 900.0
"""A batch that takes longer hangs."""
KEPT = 100
"""Sets kept of the worst of each kind."""
MOST_ENERGY_ERROR, MOST_MASS_ERROR = 1e-3, 1e-12
WORST = ("energy_error", "mass_error", "steps", "cell_steps", "unfinished", "not_a_number")


def asked(batch: int, duration: float) -> dict[str, Request]:
    """Return the requests of a batch: every other one lets runs end when they are burnt out."""
    at = np.arange(2.5, duration, 5.0)
    requests = {"mlr": Request(at, 5.0), "mass": Request(at)}
    if batch // len(cases()) % 2:
        names = ("front_temperature", "back_temperature", "thickness", "probe_0", "probe_1")
        requests |= {name: Request(at) for name in names}
    return requests


def run_batch(batch: int, sets: int) -> dict[str, Any]:
    """Return the results of a batch."""
    case = cases()[batch % len(cases())]
    experiment, material, box = described(case)
    generator = np.random.default_rng([SEED, batch])
    values = {n: low + (high - low) * generator.random(sets) for n, (low, high) in box.items()}
    requests = asked(batch, DURATION_S[case.experiment])
    start = time.perf_counter()
    probes = (0.0005, 0.003) if "probe_0" in requests else ()
    runs = simulate_gasifications(
        experiment, material, values, requests, probes_m=probes, sets=sets
    )
    seconds = time.perf_counter() - start
    rows = [
        judged(run) | {"case": case.words, "values": {n: float(v[s]) for n, v in values.items()}}
        for s, run in enumerate(runs)
    ]
    counts = Counter(row["status"] for row in rows)
    counts["not a number in a finished run"] = sum(row["not_a_number"] for row in rows)
    for key, most in (("energy_error", MOST_ENERGY_ERROR), ("mass_error", MOST_MASS_ERROR)):
        counts[f"{key} above {most:g}"] = sum(not row[key] <= most for row in rows)
    return {
        "case": case.words,
        "counts": +counts,
        "sets": sets,
        "seconds": seconds,
        "worst": {key: worst(rows, key) for key in WORST},
    }


def judged(run: Curves) -> dict[str, Any]:
    """Return the numbers by which a run is judged."""
    finite = all(bool(np.isfinite(curve).all()) for curve in run.signals.values())
    return {
        "status": run.status.name,
        "unfinished": int(not run.status.finished),
        "not_a_number": int(run.status.finished and not (finite and run.signals)),
        "energy_error": run.energy_error,
        "mass_error": run.mass_error,
        "steps": run.steps,
        "cells": run.cells,
        "cell_steps": run.cells * run.steps,
    }


def worst(rows: list[dict[str, Any]], key: str) -> list[dict[str, Any]]:
    """Return the worst sets, the worst one first; of failures only these, of the rest no failure.

    A number that is none counts as the worst.
    """
    if key in ("unfinished", "not_a_number"):
        return [row for row in rows if row[key]][:KEPT]
    finished = [row for row in rows if not row["unfinished"]]
    return sorted(finished, key=lambda row: np.nan_to_num(row[key], nan=np.inf))[: -KEPT - 1 : -1]


def merge(state: dict[str, Any], found: dict[str, Any]) -> None:
    """Add a batch to the counts, and its worst sets to the worst."""
    of_case = state["cases"].setdefault(found["case"], {"sets": 0, "seconds": 0.0, "counts": {}})
    of_case["sets"] += found["sets"]
    of_case["seconds"] += found["seconds"]
    of_case["counts"] = Counter(of_case["counts"]) + Counter(found["counts"])
    for key in WORST:
        state["worst"][key] = worst(state["worst"].get(key, []) + found["worst"][key], key)


def write(path: Path, state: dict[str, Any]) -> None:
    """Replace the state at once, so that a stop at any time leaves a whole one."""
    beside = path.with_suffix(".part")
    beside.write_text(json.dumps(state), encoding="utf-8")
    beside.replace(path)


def new_worker() -> Pool:
    """Return a process that runs batches, and can be stopped when one hangs."""
    return multiprocessing.get_context("spawn").Pool(1)


def run(path: Path, sets: int) -> None:
    """Run batches from where the state ends until as many sets are done."""
    state: dict[str, Any] = {
        "next": 0,
        "hung": [],
        "cases": {},
        "worst": {},
    }
    if path.exists():
        state = json.loads(path.read_text(encoding="utf-8"))
    worker = new_worker()
    while (done := BATCH * state["next"]) < sets:
        batch = state["next"]
        count = min(BATCH, sets - done)
        try:
            merge(state, worker.apply_async(run_batch, (batch, count)).get(LIMIT_S))
        except multiprocessing.TimeoutError:
            worker.terminate()
            worker = new_worker()
            state["hung"].append({"batch": batch, "case": cases()[batch % len(cases())].words})
        state["next"] += 1
        write(path, state)
        print(done + count, dict(summed(state)), flush=True)
    worker.terminate()


def main() -> None:
    """Run, or write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--sets", type=int, default=1_000_000)
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    path = given.folder / "state.json"
    if given.page:
        put_section("Robustness", page(json.loads(path.read_text(encoding="utf-8"))))
        return
    given.folder.mkdir(parents=True, exist_ok=True)
    run(path, given.sets)


if __name__ == "__main__":
    main()
