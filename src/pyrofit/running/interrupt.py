"""Ctrl-C and SIGTERM in a run: all processes end at once, and one line says how to go on."""

import contextlib
import importlib
import os
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

from pyrofit.errors import INTERRUPTED
from pyrofit.running.lock import end_run

SIGNALS = (signal.SIGINT, signal.SIGTERM)
PATIENCE_S = 10.0
"""Time that jobs get to end by themselves."""


def end_while_starting() -> None:
    """Let Ctrl-C or SIGTERM end a run whose jobs have not started: there is nothing to keep."""
    _answer(lambda: None)


def end_with_jobs(root: Path) -> None:
    """Let Ctrl-C or SIGTERM end a run on this machine with its jobs, and free the results."""

    def end() -> None:
        _end_jobs()
        end_run(root)

    _answer(end)


def end_with_cluster() -> None:
    """Let Ctrl-C or SIGTERM end a run on a cluster: Snakemake cancels its jobs."""
    for each in SIGNALS:
        signal.signal(each, signal.default_int_handler)


def _answer(end: Callable[[], None]) -> None:
    """Answer Ctrl-C and SIGTERM by one line and the end of this process."""
    if threading.current_thread() is not threading.main_thread():
        return

    def answer(number: int, frame: FrameType | None) -> None:
        for each in SIGNALS:
            signal.signal(each, lambda number, frame: None)
        with contextlib.suppress(RuntimeError):  # the signal came in the middle of a write
            sys.stdout.flush()
            sys.stderr.flush()
        said = os.dup(2)
        # Jobs that end would be reported as failed.
        for stream in (1, 2):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        end()
        # Last, because jobs still write until they have ended.
        with contextlib.suppress(OSError):
            os.write(said, f"{INTERRUPTED}\n".encode())
        os._exit(128 + number)

    for each in SIGNALS:
        signal.signal(each, answer)


def _end_jobs() -> None:
    """End all processes that this one started, and wait for them."""
    psutil: Any = importlib.import_module("psutil")  # Snakemake brings it
    jobs = psutil.Process().children(recursive=True)
    for job in jobs:
        with contextlib.suppress(psutil.NoSuchProcess):
            job.terminate()
    for job in psutil.wait_procs(jobs, PATIENCE_S)[1]:
        with contextlib.suppress(psutil.NoSuchProcess):
            job.kill()
