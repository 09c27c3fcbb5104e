"""Lines on long searches: how far they are, and the time left."""

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial

from pyrofit.estimate.history import Progress
from pyrofit.estimate.problem import Outcome, Problem
from pyrofit.running.durations import in_words
from pyrofit.solver.arrays import FloatArray

OFTEN_S = 2.0
"""Shortest time between two lines."""
CALLS_OFTEN_S = 20.0
"""The same of lines that count model calls."""


class Told:
    """Tells how far searches side by side are, on standard error.

    Parameters
    ----------
    label
        Begins each line.
    searches
        Their number.
    generations
        Number of generations of each.
    clock
        Returns the time [s].
    """

    def __init__(
        self,
        label: str,
        searches: int,
        generations: int,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.of_each: list[Progress] = [partial(self._tell, n) for n in range(searches)]
        """To be called at the start of each generation of each search."""
        self._label, self._generations, self._clock = label, generations, clock
        self._calls = [0] * searches
        self._best = [float("inf")] * searches
        self._furthest = 1
        self._began: tuple[float, int] | None = None
        self._last = -OFTEN_S

    def _tell(self, search: int, generation: int, calls: int, best: float) -> None:
        self._calls[search], self._best[search] = calls, best
        if generation <= self._furthest:
            return
        self._furthest = generation
        now = self._clock()
        self._began = self._began or (now, generation)
        if now - self._last >= OFTEN_S or generation == self._generations:
            self._last = now
            self._print(now)

    def _print(self, now: float) -> None:
        began, first = self._began or (now, self._furthest)
        left = ""
        if first < self._furthest < self._generations:
            each = (now - began) / (self._furthest - first)
            left = f", about {in_words(each * (self._generations + 1 - self._furthest))} left"
        print(
            f"{self._label}: generation {self._furthest} of {self._generations}, "
            f"{sum(self._calls):,} model calls, lowest cost {min(self._best):.4g}{left}",
            file=sys.stderr,
            flush=True,
        )


class CallsTold:
    """Tells how many model calls of a search are done, on standard error.

    Parameters
    ----------
    label
        Begins each line.
    expected
        Approximate number of calls of the whole search.
    clock
        Returns the time [s].
    """

    def __init__(
        self, label: str, expected: int, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._label, self._expected, self._clock = label, expected, clock
        self.calls = 0
        """Calls that are done."""
        self._began = self._last = clock()

    def add(self, calls: int) -> None:
        """Count further calls."""
        self.calls += calls
        now = self._clock()
        if now - self._last < CALLS_OFTEN_S:
            return
        self._last = now
        of, left = "", ""
        if self.calls < self._expected:
            rest = (now - self._began) * (self._expected / self.calls - 1.0)
            of, left = f" of about {self._expected:,}", f", about {in_words(rest)} left"
        said = f"{self._label}: {self.calls:,}{of} model calls{left}"
        print(said, file=sys.stderr, flush=True)


@dataclass(frozen=True)
class _Counted(Problem):
    """A problem that tells how many sets it has simulated."""

    told: CallsTold

    def simulate_all(self, X: FloatArray, led: bool = False) -> list[Outcome]:
        found = super().simulate_all(X, led)
        self.told.add(len(X))
        return found


def counted(problem: Problem, told: CallsTold) -> Problem:
    """Return a problem that tells how many sets it, and any changed copy, has simulated."""
    own = {field.name: getattr(problem, field.name) for field in fields(Problem)}
    return _Counted(**own, told=told)
