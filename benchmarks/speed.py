"""Evaluations per second of the slab solver at measured error, for the paper's set-up.

Run: python benchmarks/speed.py
"""

import time
from pathlib import Path

import numpy as np

from pyrofit.config import read_study
from pyrofit.model.experiment import Gasification
from pyrofit.simulate import Accuracy, simulate_gasification
from pyrofit.solver.curves import Request

ROOT = Path(__file__).parents[1]
SETTINGS = {
    "default": Accuracy(),
    "0.2 %": Accuracy(cells=30, tolerance=1e-2, longest_step_s=40.0, first_step_s=0.1),
}
REFERENCE = Accuracy(cells=800, tolerance=5e-5, longest_step_s=1.0, most_steps=200_000)
DURATION_S = {"capa_25": 1690.0, "capa_60": 400.0}
BIN_S = 5.0
REPEATS = 7


def main() -> None:
    """Print error, evaluations per second and steps of each setting at both fluxes."""
    study = read_study(ROOT / "config" / "paper.yaml")
    material = study.material_with("Table 3")
    published = study.published.costs["RMSE"]
    values = {n: published[n][0] * study.parameters[n].factor for n in study.imp.estimate}
    print(f"{'experiment':10} {'setting':8} {'cells':>5} {'error %':>8} {'1/s':>7} {'steps':>6}")
    for name, duration in DURATION_S.items():
        experiment = study.experiments[name]
        assert isinstance(experiment, Gasification)
        request = {"mlr": Request(np.arange(BIN_S / 2, duration, BIN_S), BIN_S)}
        reference = simulate_gasification(experiment, material, values, request, REFERENCE)
        exact = reference.signals["mlr"]
        for label, accuracy in SETTINGS.items():
            run = simulate_gasification(experiment, material, values, request, accuracy)
            error = np.sqrt(np.mean((run.signals["mlr"] - exact) ** 2)) / exact.mean()
            times = []
            for _ in range(REPEATS):
                start = time.perf_counter()
                for _ in range(20):
                    simulate_gasification(experiment, material, values, request, accuracy)
                times.append((time.perf_counter() - start) / 20)
            print(
                f"{name:10} {label:8} {run.cells:5d} {100 * error:8.3f} "
                f"{1 / np.median(times):7.0f} {run.steps:6d}"
            )


if __name__ == "__main__":
    main()
