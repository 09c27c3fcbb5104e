"""The share of a run's work that is done, and the time left, after each step of the workflow.

Snakemake counts steps, of which one lasts a second and another an hour. Here a step counts by its
time: that of finished steps of its rule, or its usual time and that of its model calls. How far
steps last longer than usual is learned from those that have ended, the time of a call from finished
searches. The share never falls.
"""

import logging
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pyrofit.running.durations import in_words

TARGETS = ("all", "diagnose", "fds", "fds_check")
"""Rules that compute nothing."""
START_S = 2.0
"""Usual time of a step besides its model calls [s]."""
USUAL_S = {
    **dict.fromkeys(TARGETS, 0.0),
    "preview": 25.0,
    "isoconversional": 25.0,
    "kinetics": 20.0,
    "identify_kinetics": 20.0,
    "identify": 20.0,
    "compare": 5.0,
}
"""That of analyses [s], by the name of their rule: means of four studies of measured files."""
ALONE = ("prepare", "kinetics", "identify_kinetics", "identify", "collect", "report", "diagnosis")
"""Rules that the others wait for, or which use all cores."""
PRIOR_S = 10.0
"""Finished steps of fewer seconds tell little of how long the others last."""
CALL_S = 4e-4
"""Time of a model call [s], until the first search has ended."""
MOST = 99.0
"""Largest share that is told while a step is left [%]."""
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
        self._shown = 0.0

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
        text = f"{min(100.0 * self._share(), MOST):.0f} %"
        if self._cores and self._call_s() is not None:
            text += f", about {in_words(self._left_s(self._cores))} left"
        return text

    def _share(self) -> float:
        """Return the share of the work that is done, at least that of the line before."""
        done = self._done()
        left = sum(seconds for _, seconds in self._left())
        self._shown = max(self._shown, done / max(done + left, 1e-9))
        return self._shown

    def _left_s(self, cores: int) -> float:
        """Return the time left [s]: of steps alone, and of the others side by side."""
        left = list(self._left())
        alone = sum(seconds for rule, seconds in left if rule in ALONE)
        return alone + sum(seconds for rule, seconds in left if rule not in ALONE) / cores

    def _done(self) -> float:
        """Return the work that is done [s]."""
        running = (self._clock() - start for _, start in self._running.values())
        return sum(map(sum, self._took.values())) + sum(running)

    def _left(self) -> Iterator[tuple[str, float]]:
        """Yield the work left of each rule [s]; one that lasts longer than expected ends soon."""
        now = self._clock()
        for rule, planned in self._planned.items():
            running = [now - start for name, start in self._running.values() if name == rule]
            expected, ended = self._expected(rule), len(self._took[rule])
            waiting = max(planned - ended - len(running), 0)
            yield rule, waiting * expected + sum(max(expected - t, 0.0) for t in running)

    def _expected(self, rule: str) -> float:
        took = self._took[rule]
        if took:
            return sum(took) / len(took)
        return self._usual(rule) + self._calls.get(rule, 0.0) * (self._call_s() or CALL_S)

    def _usual(self, rule: str) -> float:
        """Return the time of a step besides its model calls [s].

        It is the usual one times the ratio by which finished steps without calls have lasted
        longer.
        """
        ended = {name: took for name, took in self._took.items() if name not in self._calls}
        lasted = sum(map(sum, ended.values()))
        usual = sum(len(took) * USUAL_S.get(name, START_S) for name, took in ended.items())
        return USUAL_S.get(rule, START_S) * (PRIOR_S + lasted) / (PRIOR_S + usual)

    def _call_s(self) -> float | None:
        """Return the time of a model call [s] in the searches that have ended; None without one.

        The shortest: the first searches may have compiled the solver as well.
        """
        return min(
            (
                max(t - self._usual(rule), 0.0) / self._calls[rule]
                for rule, took in self._took.items()
                if self._calls.get(rule)
                for t in took
            ),
            default=None,
        )
