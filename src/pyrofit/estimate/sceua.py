"""SCE-UA (Duan et al. 1993, doi 10.1007/BF00939380) as SPOTPY implements it."""

import contextlib
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
import spotpy

from pyrofit.estimate.history import Progress
from pyrofit.estimate.problem import Evaluation, Problem
from pyrofit.estimate.turns import in_turns
from pyrofit.solver.arrays import FloatArray

Ask = Callable[[FloatArray], Evaluation]


@dataclass
class _Setup:
    """Interface of a model to SPOTPY; records every call."""

    problem: Problem
    ask: Ask
    calls: list[tuple[Any, ...]] = field(default_factory=list)
    generation: int = 1
    best: float = np.inf

    def parameters(self) -> Any:
        """Return one random parameter set with the limits, as SPOTPY wants it."""
        return spotpy.parameter.generate(self._distributions)

    def __post_init__(self) -> None:
        # SPOTPY guesses limits from random draws unless minbound and maxbound are given.
        self._distributions = [
            spotpy.parameter.Uniform(name, low, high, minbound=low, maxbound=high, optguess=low)
            for name, low, high in zip(
                self.problem.names,
                self.problem.lower.tolist(),
                self.problem.upper.tolist(),
                strict=True,
            )
        ]

    def simulation(self, vector: Any) -> list[float]:
        """Evaluate a parameter set; the "simulation" that SPOTPY keeps is its cost."""
        x = np.array(list(vector), dtype=np.float64)
        result = self.ask(x)
        self.best = min(self.best, result.cost)
        self.calls.append(
            (self.generation, result.cost, int(result.status), *result.parts, *x.tolist())
        )
        return [result.cost]

    def evaluation(self) -> list[float]:
        """Return nothing to compare with: the cost is complete."""
        return [0.0]

    def objectivefunction(
        self, simulation: list[float], evaluation: Any, params: Any = None
    ) -> float:
        """Return the cost; SCE-UA minimises it."""
        return simulation[0]


class _Search(spotpy.algorithms.sceua):  # type: ignore[misc]
    """SCE-UA that tells the setup which generation runs."""

    def __init__(self, setup: _Setup, seed: int, progress: Progress | None) -> None:
        super().__init__(setup, dbformat="ram", save_sim=False, random_state=seed)
        self._progress = progress
        self._evolved = 0

    def simulate(self, id_params_tuple: Any) -> Any:
        """Count generations: the burn-in is the first, each loop over the complexes one more."""
        setup = self.setup
        if self.repeat.phase:
            generation = 2 + self._evolved // self.ngs
            self._evolved += 1
            if generation != setup.generation:
                setup.generation = generation
                self._tell(generation)
        return super().simulate(id_params_tuple)

    def _tell(self, generation: int) -> None:
        if self._progress is not None:
            self._progress(generation, len(self.setup.calls), self.setup.best)


def search(
    problem: Problem,
    seed: int,
    generations: int,
    complexes: int | None = None,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Minimise a cost with SCE-UA and return the history of every model call.

    Parameters
    ----------
    problem
        The cost to minimise, of n parameters.
    seed
        Seed of the search; equal seeds give equal bits.
    generations
        Number of generations of (2 n + 1) complexes points each, the burn-in counted as the first.
    complexes
        Number of complexes; default n.
    progress
        Told about each generation.

    Returns
    -------
    pandas.DataFrame
        One row per call, in order: ``call``, ``generation``, ``cost``, ``status``,
        ``cost_0`` ... for the weighted terms, and the parameters in SI units.
    """
    return search_several(problem, [seed], generations, complexes, [progress])[0]


def search_several(
    problem: Problem,
    seeds: Sequence[int],
    generations: int,
    complexes: int | None = None,
    progress: Sequence[Progress | None] = (),
) -> list[pd.DataFrame]:
    """Return the histories of searches that differ in their seeds.

    They run side by side: the solver is two to three times as fast with eight parameter sets;
    each has the bits of `search` with its seed.
    """
    one = partial(_search, problem, generations, complexes)
    searches = [
        partial(one, seed, told)
        for seed, told in zip(seeds, progress or [None] * len(seeds), strict=True)
    ]
    with contextlib.redirect_stdout(io.StringIO()):
        return in_turns(searches, lambda asked: problem.evaluate_all(np.array(asked)))


def _search(
    problem: Problem,
    generations: int,
    complexes: int | None,
    seed: int,
    progress: Progress | None,
    ask: Ask,
) -> pd.DataFrame:
    setup = _Setup(problem, ask)
    # SPOTPY draws from the global generators while it is built: seed before.
    np.random.seed(seed)  # noqa: NPY002
    _Search(setup, seed, progress).sample(
        repetitions=10**9,
        ngs=complexes or len(problem.names),
        kstop=generations + 1,
        pcento=1e-12,
        peps=1e-12,
        max_loop_inc=generations - 1,
    )
    return _frame(setup, problem)


def _frame(setup: _Setup, problem: Problem) -> pd.DataFrame:
    parts = [f"cost_{i}" for i in range(len(problem.picks))]
    columns = ["generation", "cost", "status", *parts, *problem.names]
    frame = pd.DataFrame(setup.calls, columns=columns)
    frame.insert(0, "call", np.arange(1, len(frame) + 1))
    return frame
