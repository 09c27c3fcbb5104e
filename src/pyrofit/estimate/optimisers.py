"""The optimisers beside SCE-UA: each goes from several random starts on the same cost.

A new one takes its own module, its settings in `config.stages.Imp` under the same key, and an
entry here. The workflow then runs it, and tables and figures show it.
"""

from collections.abc import Callable
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
    """

    words: str
    run: Run
    calls: Calls
    marker: str
    shape: str

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
    "cmaes": Optimiser("CMA-ES", _cmaes, _calls_of_cmaes, "s", "squares"),
}
"""By the key of their settings in a study, which is also the name of their files of results."""
