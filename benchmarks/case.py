"""The set-up that is timed: config/paper.yaml, Table 3 kinetics, the published RMSE set."""

import time
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from pyrofit.config import Study, read_study
from pyrofit.experiments import Gasification
from pyrofit.model.accuracy import Accuracy
from pyrofit.model.material import Material
from pyrofit.simulate import simulate_gasifications
from pyrofit.solver.arrays import FloatArray, Values
from pyrofit.solver.curves import Curves, Request
from pyrofit.solver.kernels import slab as kernel
from pyrofit.solver.run import LANES

ROOT = Path(__file__).parents[1]
FLUXES = {"capa_25": 25, "capa_60": 60}
"""Experiments, and their flux [kW/m2]."""
DURATION_S = {"capa_25": 1690.0, "capa_60": 400.0}
BIN_S = 5.0
FINE = Accuracy(cells=800, tolerance=5e-5, longest_step_s=1.0, most_steps=200_000)
LEAST_S = 1.0
"""A timing is the minimum over as many repeats as this takes."""


class Setup(NamedTuple):
    """Inputs of a simulation."""

    experiment: Gasification
    material: Material
    values: Mapping[str, float]
    requests: Mapping[str, Request]

    def run(
        self, accuracy: Accuracy | None = None, sets: int = 1, threads: int = 1
    ) -> list[Curves]:
        """Run it, the same set several times where asked."""
        values: Values = self.values
        if sets > 1:
            values = {name: np.full(sets, x) for name, x in self.values.items()}
        return self.run_sets(values, sets, accuracy, threads)

    def run_sets(
        self, values: Values, sets: int, accuracy: Accuracy | None = None, threads: int = 1
    ) -> list[Curves]:
        """Run sets of values."""
        return simulate_gasifications(
            self.experiment,
            self.material,
            values,
            self.requests,
            accuracy,
            sets=sets,
            threads=threads,
        )


@cache
def study() -> Study:
    """Return the study of the paper."""
    return read_study(ROOT / "config" / "paper.yaml")


@cache
def setup(name: str) -> Setup:
    """Return the paper's set-up of an experiment."""
    paper = study()
    experiment = paper.experiments[name]
    assert isinstance(experiment, Gasification)
    published = paper.published.costs["RMSE"]  # type: ignore[union-attr]
    values = {n: published[n][0] * paper.parameters[n].factor for n in paper.imp.estimate}
    at = np.arange(BIN_S / 2, DURATION_S[name], BIN_S)
    return Setup(experiment, paper.material_with("Table 3"), values, {"mlr": Request(at, BIN_S)})


@cache
def exact(name: str) -> FloatArray:
    """Return the fine solution."""
    return setup(name).run(FINE)[0].signals["mlr"]


def relative_error(curve: FloatArray, of: FloatArray) -> float:
    """Return the root mean square of the difference over the mean."""
    return float(np.sqrt(np.mean((curve - of) ** 2)) / of.mean())


def error(name: str, accuracy: Accuracy) -> float:
    """Return the error of the published set against the fine solution."""
    return relative_error(setup(name).run(accuracy)[0].signals["mlr"], exact(name))


def seconds(run: Callable[[], Any], least: float = LEAST_S) -> float:
    """Return the shortest of repeated runs that take ``least`` [s] together, after a first one."""
    run()
    best = np.inf
    begin = time.perf_counter()
    while time.perf_counter() - begin < least:
        start = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - start)
    return float(best)


class _Caught(Exception):  # noqa: N818
    """Carries the arguments of a call of the kernel."""


def kernel_arguments(given: Setup, accuracy: Accuracy, sets: int) -> tuple[Any, ...]:
    """Return the arguments of the kernel for one set or several equal ones."""

    def catch(*arguments: Any) -> None:
        raise _Caught(arguments)

    original = kernel.slab, kernel.slabs
    kernel.slab = kernel.slabs = catch
    try:
        given.run(accuracy, sets)
    except _Caught as caught:
        return tuple(caught.args[0])
    finally:
        kernel.slab, kernel.slabs = original
    raise AssertionError


class Rates(NamedTuple):
    """Evaluations per second on one core."""

    scalar: float
    lanes: float
    kernel_scalar: float
    kernel_lanes: float
    steps: int
    cells: int

    def per_cell_step_ns(self, which: str) -> float:
        """Return the time per cell and step of one set [ns]."""
        return 1e9 / float(getattr(self, which)) / (self.steps * self.cells)


def rates(given: Setup, accuracy: Accuracy, least: float = LEAST_S) -> Rates:
    """Time a set alone and in all lanes, the kernel and the whole evaluation."""
    one, all_lanes = (kernel_arguments(given, accuracy, sets) for sets in (1, LANES))
    found = given.run(accuracy)[0]
    assert found.status.finished
    return Rates(
        1.0 / seconds(lambda: given.run(accuracy), least),
        LANES / seconds(lambda: given.run(accuracy, LANES), least),
        1.0 / seconds(lambda: kernel.slab(*one), least),
        LANES / seconds(lambda: kernel.slabs(*all_lanes), least),
        found.steps,
        found.cells or int(one[2].shape[0]),
    )
