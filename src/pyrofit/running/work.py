"""The share of a run's work that is done, and the time left, after each step of the workflow.

Snakemake counts steps, of which one lasts a second and another an hour. Here a step counts by its
time: that of finished steps of its rule, or the time of its model calls. The time of a call is
learned from finished searches.
"""

import logging
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from statistics import median
from typing import Any

from pyrofit.running.durations import in_words

START_S = 2.0
"""Time of a step besides its model calls [s], until `ENOUGH` steps without a search have ended."""
ENOUGH = 3
CALL_S = 4e-4
"""Time of a model call [s], until the first search has ended."""
WIDTH = 20
"""Characters of the bar."""


def event_of(record: logging.LogRecord) -> str:
    """Return the name of the event that Snakemake logs, "" for a text alone."""
    return str(getattr(vars(record).get("event"), "value", ""))


class WorkDone(logging.Handler):
    """Prints a bar after each step, from the events that Snakemake logs.

    Parameters
    ----------
    calls
        Model calls of a step, by the name of its rule; none where there is no search.
    cores
        Steps that run at once; None where nobody knows, as on a cluster: then no time is given.
    tell
        Takes a line.
    clock
        Returns the time [s].
    """

    def __init__(
        self,
        calls: Mapping[str, float],
        cores: int | None,
        tell: Callable[[str], None] = lambda line: print(line, file=sys.stderr, flush=True),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__()
        self._calls, self._cores, self._say, self._clock = calls, cores, tell, clock
        self._planned: dict[str, int] = {}
        self._running: dict[int, tuple[str, float]] = {}
        self._took: dict[str, list[float]] = defaultdict(list)

    def emit(self, record: logging.LogRecord) -> None:
        """Note an event; print the bar where Snakemake tells its progress."""
        self.note(event := event_of(record), about := vars(record))
        if event == "progress" and about["done"] < about["total"]:
            share = self._share()
            self._say(f"work: [{'#' * int(WIDTH * share):.<{WIDTH}}] {self.words()}")

    def note(self, event: str, about: Mapping[str, Any]) -> None:
        """Note an event of Snakemake and what it is about."""
        if event == "run_info":
            self._planned = {rule: n for rule, n in about["stats"].items() if rule != "total"}
        elif event == "job_info":
            self._running[about["jobid"]] = about["rule_name"], self._clock()
        elif event == "job_finished" and about["job_id"] in self._running:
            rule, start = self._running.pop(about["job_id"])
            self._took[rule].append(self._clock() - start)

    @property
    def planned(self) -> Mapping[str, int]:
        """Number of steps by the name of their rule."""
        return self._planned

    def words(self) -> str:
        """Return the share of the work that is done, and the time left if it is known."""
        text = f"{100 * self._share():.0f} %"
        if self._cores and self._call_s() is not None:
            text += f", about {in_words(max(self._total() - self._done(), 0.0) / self._cores)} left"
        return text

    def _share(self) -> float:
        return min(self._done() / max(self._total(), 1e-9), 1.0)

    def _ended(self) -> float:
        return sum(map(sum, self._took.values()))

    def _done(self) -> float:
        """Return the work that is done [s]."""
        now = self._clock()
        return self._ended() + sum(
            min(now - start, self._expected(rule)) for rule, start in self._running.values()
        )

    def _total(self) -> float:
        """Return the work of the run [s]."""
        return self._ended() + sum(
            (planned - len(self._took[rule])) * self._expected(rule)
            for rule, planned in self._planned.items()
        )

    def _expected(self, rule: str) -> float:
        took = self._took[rule]
        if took:
            return sum(took) / len(took)
        return self._start_s() + self._calls.get(rule, 0.0) * (self._call_s() or CALL_S)

    def _start_s(self) -> float:
        """Return the time of a step without a search [s]."""
        short = [t for rule, took in self._took.items() if rule not in self._calls for t in took]
        return median(short) if len(short) >= ENOUGH else START_S

    def _call_s(self) -> float | None:
        """Return the time of a model call [s] in the searches that have ended; None without one.

        The shortest: the first searches may have compiled the solver as well.
        """
        start = self._start_s()
        return min(
            (
                max(t - start, 0.0) / self._calls[rule]
                for rule, took in self._took.items()
                if self._calls.get(rule)
                for t in took
            ),
            default=None,
        )
