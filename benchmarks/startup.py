"""Time spent before and beside the solver: imports, first calls, compiling, a job.

Everything runs in a process of its own.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from page import filed, table

HERE = Path(__file__).parent
SMOKE = HERE.parent / "config" / "smoke.yaml"
NOTE = (
    "One repetition of `config/smoke.yaml` (`pyrofit imp --cost RMSE --repetition 0`), a small "
    "job, the shortest of three, compiled code on disk:"
)
JOB = ("--cost", "RMSE", "--repetition", "0")

FIRST_CALLS = """
import json, sys, time
start = time.perf_counter()
import pyrofit.simulate
imported = time.perf_counter()
sys.path.insert(0, {here!r})
from case import setup
given = setup("capa_25")
times = dict(**{{"import": imported - start}})
for name, sets in (("scalar", 1), ("scalar again", 1), ("lanes", 8), ("lanes again", 8)):
    start = time.perf_counter()
    given.run(None, sets)
    times[name] = time.perf_counter() - start
print(json.dumps(times))
"""

JOB_TIMES = """
import json, sys, time
spent = dict.fromkeys(("solver", "evaluate", "search"), 0.0)
def timed(name, function):
    def run(*given, **named):
        start = time.perf_counter()
        try:
            return function(*given, **named)
        finally:
            spent[name] += time.perf_counter() - start
    return run
start = time.perf_counter()
from pyrofit import cli
from pyrofit.estimate import problem
spent["imports"] = time.perf_counter() - start
from pyrofit.estimate import sceua
spent["library"] = time.perf_counter() - start - spent["imports"]
from pyrofit.solver.kernels import slab
spent["numba"] = time.perf_counter() - start - spent["imports"] - spent["library"]
from pyrofit.stages import fit
spent["imports"] = time.perf_counter() - start - spent["library"] - spent["numba"]
problem.Problem.simulated = timed("solver", problem.Problem.simulated)
problem.Problem.evaluate_all = timed("evaluate", problem.Problem.evaluate_all)
problem.Problem.evaluate = timed("evaluate", problem.Problem.evaluate)
search = sceua.search_several
def searched(*given, **named):
    before, start = spent["evaluate"], time.perf_counter()
    found = search(*given, **named)
    spent["search"] = time.perf_counter() - start - spent["evaluate"] + before
    return found
sceua.search_several = searched
code = cli.main(sys.argv[1:])
spent["all"] = time.perf_counter() - start
print(json.dumps(spent))
sys.exit(code)
"""


def child(code: str, *arguments: str, **environment: str) -> tuple[dict[str, float], float]:
    """Return the JSON that a process prints at its end, and how long it ran [s]."""
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        env={**os.environ, **environment},
        check=True,
        capture_output=True,
        text=True,
    )
    took = time.perf_counter() - start
    return json.loads(done.stdout.splitlines()[-1]), took


def best_of(runs: list[tuple[dict[str, float], float]]) -> tuple[dict[str, float], float]:
    """Return the shortest of several processes."""
    return min(runs, key=lambda run: run[1])


def first_calls() -> str:
    """Time import and first calls, with the compiled code on disk and without."""
    code = FIRST_CALLS.format(here=str(HERE))
    child(code)
    warm, _ = best_of([child(code) for _ in range(5)])
    with tempfile.TemporaryDirectory() as empty:
        cold, _ = child(code, NUMBA_CACHE_DIR=empty)
    rows = [
        ("import pyrofit.simulate", warm["import"], cold["import"]),
        ("first call, one set", warm["scalar"], cold["scalar"]),
        ("second call, one set", warm["scalar again"], cold["scalar again"]),
        ("first call, eight sets", warm["lanes"], cold["lanes"]),
        ("second call, eight sets", warm["lanes again"], cold["lanes again"]),
    ]
    head = ("in a fresh process", "compiled code on disk [s]", "nothing on disk [s]")
    return table(head, [(label, f"{a:.4f}", f"{b:.4f}") for label, a, b in rows])


def job() -> str:
    """Time one repetition of config/smoke.yaml, and its part outside solver and SPOTPY."""
    with tempfile.TemporaryDirectory() as folder:
        for step in ("prepare", "kinetics"):
            child(JOB_TIMES, step, "--study", str(SMOKE), "--results", folder)
        return parts(Path(folder), SMOKE, JOB)


def parts(results: Path, study: Path, options: tuple[str, ...]) -> str:
    """Return the times of the parts of a job, the shortest of three; its inputs are there."""
    command = ("imp", "--study", str(study), "--results", str(results), *options)
    spent, took = best_of([child(JOB_TIMES, *command) for _ in range(3)])
    library = spent["library"] + spent["search"]
    outside = took - spent["numba"] - spent["solver"] - library
    rows = [
        ("solver: numba, which loads its compiled code", spent["numba"]),
        ("solver: compiled code and runs", spent["solver"]),
        ("SPOTPY, loading it counted", library),
        ("imports of all else", spent["imports"]),
        ("cost", spent["evaluate"] - spent["solver"]),
        (
            "rest (interpreter, study, files)",
            outside - spent["imports"] - spent["evaluate"] + spent["solver"],
        ),
        ("all", took),
        ("**outside solver and SPOTPY**", outside),
    ]
    timed = [(label, f"{s:.3f}") for label, s in rows]
    return filed(f"job_{study.stem}", "The parts of the job", ("part of the job", "s"), timed) + "."
