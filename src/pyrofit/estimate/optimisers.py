"""The optimisers beside SCE-UA: each goes from several random starts on the same cost.

A new one takes its own module, its settings in `config.stages.Imp` under the same key, and an
entry here. The workflow then runs it, and tables and figures show it.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

STEPS = 20
"""Typical number of steps of least squares from one start."""
Run = Callable[[Any, Any, int], Any]
Calls = Callable[[Any, int], int]


class Optimiser(NamedTuple):
    """An optimiser that goes from several random starts.

    Parameters
    ----------
    words
        Its name in words.
    run
        From problem, its settings of the study, and seed to its ends, best first.
    calls
        From its settings and the number of parameters to its approximate number of model calls.
    marker
        Marker of its sets in figures, as Matplotlib names it.
    shape
        Several such markers in words.
    coarse
        Whether it searches with the coarser runs of `coarse.for_search`; it must not need slopes.
    """

    words: str
    run: Run
    calls: Calls
    marker: str
    shape: str
    coarse: bool = False

    def searched(self, problem: Any, settings: Any, seed: int) -> Any:
        """Return its ends, best first, with the costs of the problem's own runs.

        Where coarser runs are not good at every end, the search is made again without them.
        """
        import numpy as np  # not above: every command reads this catalogue

        from pyrofit.estimate.coarse import are_close, for_search

        rough = for_search(problem) if self.coarse else problem
        starts = self.run(rough, settings, seed)
        if rough is problem:
            return starts
        ends = np.array([start.values for start in starts])
        if not all(are_close(rough, problem, ends)):
            return self.run(problem, settings, seed)
        costs = [end.cost for end in problem.evaluate_all(ends)]
        found = [replace(start, cost=cost) for start, cost in zip(starts, costs, strict=True)]
        return sorted(found, key=lambda start: start.cost)

    @property
    def title(self) -> str:
        """Name of its step of the workflow.

        >>> OPTIMISERS["least_squares"].title
        'Multistart least squares'
        """
        return self.words if self.words[0].isupper() else f"Multistart {self.words}"

    @property
    def command(self) -> str:
        """Name of its command.

        >>> OPTIMISERS["least_squares"].command
        'least-squares'
        """
        return self.words.casefold().replace(" ", "-")


def _least_squares(problem: Any, settings: Any, seed: int) -> Any:
    from pyrofit.estimate.least_squares import multistart

    return multistart(problem, settings.starts, seed)


def _cmaes(problem: Any, settings: Any, seed: int) -> Any:
    from pyrofit.estimate import cmaes  # which is loaded by the jobs alone that run it

    return cmaes.minimise(problem, settings.starts, seed, settings.calls)


def _calls_of_least_squares(settings: Any, n: int) -> int:
    return int(settings.starts * STEPS * (2 * n + 1))


def _calls_of_cmaes(settings: Any, n: int) -> int:
    return int(settings.starts * settings.calls)


OPTIMISERS: dict[str, Optimiser] = {
    "least_squares": Optimiser(
        "least squares", _least_squares, _calls_of_least_squares, "D", "diamonds"
    ),
    "cmaes": Optimiser("CMA-ES", _cmaes, _calls_of_cmaes, "s", "squares", coarse=True),
}
"""By the key of their settings in a study, which is also the name of their files of results."""
