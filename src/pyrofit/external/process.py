"""A program in a folder: started without a shell, and killed with all that it started."""

import contextlib
import os
import signal
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

OUT, ERR = "pyrofit_stdout.txt", "pyrofit_stderr.txt"
"""Files in the folder that hold what a program writes to its terminal."""
MOST_SAID = 1_000_000
"""Bytes at the end of each of them that are looked at."""


class Ended(NamedTuple):
    """How a program ended.

    Parameters
    ----------
    why
        Why it did not end by itself; empty where it did.
    status
        Exit status, negative for a signal; None where it did not end by itself.
    seconds
        Wall time [s].
    out, err
        What it wrote to its standard output and error, the end of much.
    """

    why: str
    status: int | None
    seconds: float
    out: str = ""
    err: str = ""

    @property
    def said(self) -> str:
        """What it wrote to its terminal."""
        return self.out + self.err


class Groups:
    """Groups of processes that run, each begun by a program; several threads may start them."""

    def __init__(self) -> None:
        self.is_over = False
        self._running: set[int] = set()
        self._lock = threading.Lock()

    def add(self, group: int) -> None:
        """Note a group that has begun; where all is over, kill it."""
        with self._lock:
            self._running.add(group)
        if self.is_over:
            self.end(group)

    def end(self, group: int) -> None:
        """Kill what is left of a group, and forget it."""
        with self._lock, contextlib.suppress(ProcessLookupError, PermissionError):
            self._running.discard(group)
            os.killpg(group, signal.SIGKILL)

    def end_all(self) -> None:
        """Kill all that runs, and what begins later."""
        self.is_over = True
        for group in list(self._running):
            self.end(group)


def run_process(
    words: Sequence[str],
    folder: Path,
    environment: Mapping[str, str],
    limit_s: float,
    groups: Groups | None = None,
) -> Ended:
    """Run a program in a folder; after the time limit it is killed with all that it started.

    So it is where this process is interrupted meanwhile.

    Parameters
    ----------
    words
        The program and its arguments.
    folder
        Where it runs.
    environment
        All variables of its environment.
    limit_s
        Time limit [s].
    groups
        Those that another thread may kill.

    Raises
    ------
    InterruptedError
        Another thread has killed it.
    """
    groups = groups or Groups()
    begin = time.monotonic()
    with (folder / OUT).open("wb") as out, (folder / ERR).open("wb") as err:
        try:
            process = subprocess.Popen(
                list(words),
                cwd=folder,
                env=dict(environment),
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                start_new_session=True,
            )
        except OSError as error:
            return Ended(f"it cannot be started ({error.strerror})", None, 0.0)
    why = ""
    status: int | None = None
    groups.add(process.pid)
    try:
        status = process.wait(limit_s)
    except subprocess.TimeoutExpired:
        why = f"it did not end within {limit_s:g} s"
    finally:
        # What it left running goes, too: its processes are one group.
        groups.end(process.pid)
        process.wait()
    if groups.is_over:
        raise InterruptedError("the run was killed from outside: it tells nothing")
    seconds = time.monotonic() - begin
    return Ended(why, status, seconds, _end_of(folder / OUT), _end_of(folder / ERR))


def _end_of(path: Path) -> str:
    """Return the end of a text file."""
    with path.open("rb") as file:
        file.seek(max(0, path.stat().st_size - MOST_SAID))
        return file.read().decode(errors="replace")


def last_lines(text: str, most: int = 15) -> list[str]:
    """Return the last lines of a text that are not blank.

    >>> last_lines("a" + chr(10) + "  b" + chr(10), 1)
    ['  b']
    """
    return [line.rstrip() for line in text.splitlines() if line.strip()][-most:]
