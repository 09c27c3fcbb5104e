"""Parameter sets side by side against the instruction set of the processor."""

import json
import os
import subprocess
import sys
import time

import numpy as np
from case import FLUXES, Setup, setup
from cost import words
from page import filed

from pyrofit.model.accuracy import Accuracy
from pyrofit.solver import run

AVX2 = {
    "NUMBA_CPU_NAME": "haswell",
    "NUMBA_CPU_FEATURES": "+avx,+avx2,+fma,+bmi,+bmi2,+sse4.2,+popcnt,+lzcnt,+f16c",
}
"""Settings of numba that compile for processors without AVX-512."""
COMPILED_FOR = {"this processor": {}, "AVX2": AVX2}
LANES = (4, 8, 16)
SETS = (8, 24, 128)
SPREAD = 0.1
LEAST_S = 3.0
SETTINGS = {
    "capa_25": Accuracy(cells=26, tolerance=0.02, first_step_s=0.3, longest_step_s=20),
    "capa_60": Accuracy(cells=56, tolerance=0.006, first_step_s=0.3, longest_step_s=10),
}
NOTE = (
    "Evaluations per second in one thread, at the setting of 0.2 %, by the number of lanes. The "
    "sets differ by up to a tenth in each value. Results have the same bits with any number. "
    "*AVX2*: compiled for processors without AVX-512, on the same processor. Times are those of "
    "the processor, the shortest of many."
)


def measured() -> str:
    """Return the table of all numbers of lanes, each in a process of its own."""
    rows = []
    for target, settings in COMPILED_FOR.items():
        for lanes in LANES:
            done = subprocess.run(
                [sys.executable, __file__, str(lanes)],
                env={**os.environ, **settings},
                check=True,
                capture_output=True,
                text=True,
            )
            rows.append([target, lanes, *(f"{rate:,.0f}" for rate in json.loads(done.stdout))])
    heads = [f"{words(name).partition(',')[0]}, {sets} sets" for name in FLUXES for sets in SETS]
    made = filed(
        "lanes", "Table", ("compiled for", "lanes", *(f"{head}, 1/s" for head in heads)), rows
    )
    return f"{NOTE}\n\n{made}."


def rate(of: Setup, accuracy: Accuracy, sets: int) -> float:
    """Return evaluations per second of processor time."""
    draw = np.random.default_rng(1).uniform(1.0 - SPREAD, 1.0 + SPREAD, (len(of.values), sets))
    values = {n: x * d for (n, x), d in zip(of.values.items(), draw, strict=True)}
    of.run_sets(values, sets, accuracy)
    shortest, end = np.inf, time.perf_counter() + LEAST_S
    while time.perf_counter() < end:
        start = time.process_time()
        of.run_sets(values, sets, accuracy)
        shortest = min(shortest, time.process_time() - start)
    return float(sets / shortest)


def main() -> None:
    """Print the rates with the given number of lanes."""
    run.LANES = int(sys.argv[1])
    print(json.dumps([rate(setup(n), SETTINGS[n], sets) for n in FLUXES for sets in SETS]))


if __name__ == "__main__":
    main()
