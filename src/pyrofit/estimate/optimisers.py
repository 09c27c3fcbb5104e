"""The optimisers beside SCE-UA: each goes from several random starts on the same cost.

A new one takes its own module, its settings in `config.stages.Imp` under the same key, and an
entry here. The workflow then runs it, and tables and figures show it.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

Run = Callable[[Any, Any, int], Any]


class Optimiser(NamedTuple):
    """An optimiser that goes from several random starts.

    Parameters
    ----------
    words
        Its name in words.
    run
        From problem, its settings of the study, and seed to its ends, best first.
    marker
        Marker of its sets in figures, as Matplotlib names it.
    """

    words: str
    run: Run
    marker: str

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


OPTIMISERS: dict[str, Optimiser] = {
    "least_squares": Optimiser("least squares", _least_squares, "D"),
    "cmaes": Optimiser("CMA-ES", _cmaes, "s"),
}
"""By the key of their settings in a study, which is also the name of their files of results."""
