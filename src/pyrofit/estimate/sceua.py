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
from pyrofit.estimate.problem import FAILED_COST, Evaluation, Problem
from pyrofit.estimate.turns import in_turns
from pyrofit.solver.arrays import FloatArray
from pyrofit.solver.run import LANES

Ask = Callable[[FloatArray], Evaluation]


@dataclass
class _Setup:
    """Interface of a model to SPOTPY; records every call."""

    problem: Problem
    distributions: list[Any]
    ask: Ask
    calls: list[tuple[Any, ...]] = field(default_factory=list)
    generation: int = 1
    best: float = np.inf

    def parameters(self) -> Any:
        """Return one random parameter set with the limits, as SPOTPY wants it."""
        return spotpy.parameter.generate(self.distributions)

    def simulation(self, x: tuple[float, ...]) -> list[float]:
        """Evaluate a parameter set; the "simulation" that SPOTPY keeps is its cost."""
        result = self.ask(np.array(x))
        self.best = min(self.best, result.cost)
        self.calls.append((self.generation, result.cost, int(result.status), *result.parts, *x))
        # SPOTPY's sort leaves the order of equal costs to the processor; failed runs cost the same.
        late = 1.0 + 1e-9 * len(self.calls) if result.cost >= FAILED_COST else 1.0
        return [result.cost * late]

    def evaluation(self) -> list[float]:
        """Return nothing to compare with: the cost is complete."""
        return [0.0]

    def objectivefunction(
        self, simulation: list[float], evaluation: Any, params: Any = None
    ) -> float:
        """Return the cost; SCE-UA minimises it."""
        return simulation[0]


def _as_they_are(*values: Any) -> tuple[float, ...]:
    """Return the values of a parameter set."""
    return tuple(map(float, values))


class _Search(spotpy.algorithms.sceua):  # type: ignore[misc]
    """SCE-UA that tells the setup which generation runs.

    SPOTPY makes records of parameters and rows of a table for each call, which takes nearly as long
    as its search. Nobody reads them here, so they are left out.
    """

    def __init__(self, setup: _Setup, seed: int, progress: Progress | None) -> None:
        super().__init__(setup, dbformat="noData", save_sim=False, random_state=seed)
        self.partype = _as_they_are
        self._limits = {"minbound": setup.problem.lower, "maxbound": setup.problem.upper}
        self._progress = progress
        self._evolved = 0

    def get_parameters(self) -> dict[str, FloatArray]:
        """Return one random parameter set with the limits: the draws of `_Setup.parameters`."""
        low, high = self._limits.values()
        return {"random": np.random.uniform(low, high), **self._limits}  # noqa: NPY002

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

    They run side by side: the solver is two to three times as fast with eight parameter sets.
    Each has the bits of `search` with its seed.
    """
    # In a turn of its own, for it draws from NumPy's global generator.
    (distributions,) = in_turns([lambda ask: _distributions(problem)], lambda asked: asked)
    one = partial(_search, problem, distributions, generations, complexes)
    searches = [
        partial(one, seed, told)
        for seed, told in zip(seeds, progress or [None] * len(seeds), strict=True)
    ]
    with contextlib.redirect_stdout(io.StringIO()):
        return in_turns(searches, lambda asked: problem.evaluate_all(np.array(asked)), LANES)


def _distributions(problem: Problem) -> list[Any]:
    """Return the distributions of the parameters; SPOTPY draws 100,000 numbers of each."""
    # It guesses limits from them unless minbound and maxbound are given.
    limits = zip(problem.names, problem.lower.tolist(), problem.upper.tolist(), strict=True)
    return [
        spotpy.parameter.Uniform(name, low, high, minbound=low, maxbound=high, optguess=low)
        for name, low, high in limits
    ]


def _search(
    problem: Problem,
    distributions: list[Any],
    generations: int,
    complexes: int | None,
    seed: int,
    progress: Progress | None,
    ask: Ask,
) -> pd.DataFrame:
    setup = _Setup(problem, distributions, ask)
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
