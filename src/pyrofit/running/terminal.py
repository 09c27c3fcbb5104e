"""What a run prints: its steps, its progress, the reason where it stops, and its report.

A logger plugin of Snakemake: `pyrofit run` shows a run by it. Where Snakemake was started alone,
the workflow puts it in place of Snakemake's display once the first job begins. All that Snakemake
says besides is in Snakemake's own log file.
"""

import os
import re
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from logging import ERROR, WARNING, Handler, Logger, LogRecord
from pathlib import Path
from typing import Any, NamedTuple

from snakemake_interface_logger_plugins.base import LogHandlerBase

from pyrofit.errors import BY_RUN, INTERRUPTED
from pyrofit.running.durations import in_words
from pyrofit.running.work import TARGETS, WorkDone, event_of

NAME = "pyrofit"
"""Name of the plugin: ``snakemake --logger pyrofit``."""
FOR_USER = {"for_user": True}
"""Marks a record of the workflow that is printed."""
SAME_COMMAND = "Correct this and run the same command again: finished parts are kept."
MOST_TOLD = 3
"""Failed steps whose reasons are told."""
_FOLLOWS = ("Exiting because a job execution failed",)
"""Beginnings of errors that say no more than those before."""
_TOLD = {
    "Nothing to be done": "Everything is made already: nothing to do.",
    "Terminating processes on user request": INTERRUPTED,
    "Will exit after finishing": "Ends when the steps that run now have ended.",
}
"""Sentences for what Snakemake says, by its beginning."""
_ORIGIN = re.compile(r"^\w*(?:Error|Exception)(?: in (?:rule|file) .*?)?:\n(?=\S)")
_OF_A_JOB = re.compile(r"(?:\w+:\n)?CalledProcessError in file")
"""An error that the failed step follows, which tells more."""
_PLACES = re.compile(r"^  File \".*\.(?:smk|Snakefile)\", line .*$", re.M)

About = Mapping[str, Any]
"""What Snakemake tells of an event of a run."""


class StartedStep(NamedTuple):
    """A step that was started."""

    number: int
    title: str
    since: float


class Terminal(LogHandlerBase):
    """Prints the events of a run for its user."""

    writes_to_stream = True
    writes_to_file = False
    has_filter = True
    has_formatter = True
    needs_rulegraph = False

    def __post_init__(self) -> None:
        self.work: WorkDone | None = None
        self.say: Callable[[str], None] = lambda line: print(line, file=sys.stderr, flush=True)
        self.clock: Callable[[], float] = time.monotonic
        self._total = 0
        self._steps: dict[int, StartedStep] = {}
        self._failed: list[tuple[StartedStep, Sequence[str]]] = []
        os.environ[BY_RUN] = "1"

    def emit(self, record: LogRecord) -> None:
        """Print what the user needs of an event."""
        about, event = vars(record), event_of(record)
        if self.work is not None:
            self.work.note(event, about)
        if event:
            getattr(self, f"_{event}", lambda about: None)(about)
        elif self._is_told(record):
            self.say(record.getMessage())

    def _is_told(self, record: LogRecord) -> bool:
        """Tell whether a record without an event is printed as it is."""
        text = record.getMessage()
        for beginning, sentence in _TOLD.items():
            if text.startswith(beginning):
                self.say(sentence)
                return False
        if record.levelno >= ERROR:
            return not text.startswith(_FOLLOWS)
        return record.levelno >= WARNING or "for_user" in vars(record)

    def _run_info(self, about: About) -> None:
        self.plan({rule: n for rule, n in about["stats"].items() if rule != "total"})

    def plan(self, stats: Mapping[str, int]) -> None:
        """Tell how many steps there are, by the name of their rule."""
        self._total = sum(count for rule, count in stats.items() if rule not in TARGETS)
        if not self.common_settings.dryrun:
            self.say(f"{self._total} step{'s' if self._total != 1 else ''}")

    def _job_info(self, about: About) -> None:
        title = about["rule_msg"]
        if not title:
            return
        if self.common_settings.dryrun:
            self.say(title)
            return
        before = self._steps.get(about["jobid"])
        number = before.number if before else len(self._steps) + 1
        step = self._steps[about["jobid"]] = StartedStep(number, title, self.clock())
        self.say(f"{self._place(step)}  {title}{', once more' if before else ''}")

    def _job_finished(self, about: About) -> None:
        if (step := self._steps.get(about["job_id"])) is None:
            return
        self._forget(step)
        text = f"{self._place(step)}  done in {in_words(self.clock() - step.since)}"
        if self.work is not None and step.number < self._total:
            text += f"; {self.work.words()}"
        self.say(text)

    def _job_error(self, about: About) -> None:
        if step := self._steps.get(about["jobid"]):
            self._forget(step)
            self._failed.append((step, about["log"]))
            self.say(f"{self._place(step)}  failed")

    def _forget(self, step: StartedStep) -> None:
        """Forget that an earlier attempt at a step has failed."""
        self._failed = [failed for failed in self._failed if failed[0].number != step.number]

    def _error(self, about: About) -> None:
        if _OF_A_JOB.match(str(about["msg"])):
            return
        if not self._failed:
            self.say(f"error: {in_our_words(str(about['msg']))}")
            return
        for step, logs in self._failed[:MOST_TOLD]:
            self.say(f"\n{step.title}: {reason(logs)}\nLog: {', '.join(logs)}")
        if len(self._failed) > MOST_TOLD:
            self.say(f"\n{len(self._failed) - MOST_TOLD} more failed.")
        self.say(SAME_COMMAND)

    def _place(self, step: StartedStep) -> str:
        return f"{step.number:>{len(str(self._total))}}/{self._total}"


LogHandler = Terminal
"""The name by which Snakemake finds it."""


def reason(logs: Sequence[str]) -> str:
    """Return why a step failed, by its logs: its error, or else their last line."""
    lines = [line for log in logs for line in _lines(log)]
    at = [n for n, line in enumerate(lines) if line.startswith("error: ")]
    if at:
        return "\n".join(lines[at[-1] :]).removeprefix("error: ")
    if lines:
        return f"{lines[-1]} (the log tells more; please report it)"
    return "it ended without a message in its log; the computer may lack memory or disk space"


def in_our_words(text: str) -> str:
    r"""Return an error of Snakemake without the places in the workflow, which is not the user's.

    >>> in_our_words("MissingRuleException:\nNo rule to produce postrior (if you use ...).")
    "there is no target 'postrior'; `pyrofit run --list` lists them, `pyrofit --help` single steps"
    """
    if unknown := re.search(r"No rule to produce (\S+)", text):
        known = "`pyrofit run --list` lists them, `pyrofit --help` single steps"
        return f"there is no target '{unknown[1]}'; {known}"
    if text.startswith("Traceback"):
        return f"{text.strip().splitlines()[-1]} (.snakemake/log has more; please report it)"
    return _PLACES.sub("", _ORIGIN.sub("", text.strip())).strip()


def _lines(log: str) -> list[str]:
    try:
        text = Path(log).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return []
    return [line for line in text.splitlines() if line.strip()]


def show_work(handlers: Sequence[Handler], work: WorkDone) -> bool:
    """Let the run's display tell the share of work that is done; return whether it is in use."""
    shown = [handler for handler in handlers if isinstance(handler, Terminal)]
    for handler in shown:
        handler.work = work
    return bool(shown)


def take_over(logger: Logger, settings: Any, work: WorkDone) -> None:
    """Show a run that was started by Snakemake alone, unless it was asked to tell more or less.

    Parameters
    ----------
    logger
        Snakemake's logger.
    settings
        Snakemake's settings of its output.
    work
        The share of work that is done, which has a bar in Snakemake's display.
    """
    asked = {quiet.name.lower() for quiet in settings.quiet or ()}
    more = settings.verbose or settings.debug_dag or settings.printshellcmds
    own = [handler for handler in logger.handlers if handler.name == "DefaultStreamHandler"]
    if not own or more or asked & {"all", "progress", "rules"}:
        return
    display = Terminal(settings, None)
    display.work = work
    for handler in (*own, work):
        logger.removeHandler(handler)
    logger.addHandler(display)
    display.plan(work.planned)
