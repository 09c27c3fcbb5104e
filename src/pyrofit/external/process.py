"""Run a program in a folder without a shell, and kill it with all that it started."""

import contextlib
import os
import signal
import subprocess
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from pyrofit.errors import ProgramError

OUT, ERR = "pyrofit_stdout.txt", "pyrofit_stderr.txt"
"""Files in the folder that hold the output of a program on the terminal."""
MOST_SAID = 1_000_000
"""Bytes at the end of each of these files that are read."""
FROM_OUTSIDE = (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)
"""Signals by which a user or a scheduler ends a program; they do not depend on its input."""


class Ended(NamedTuple):
    """How a program ended.

    Parameters
    ----------
    why
        Reason if it did not end by itself; else empty.
    status
        Exit status, negative for a signal; None if it did not end by itself.
    seconds
        Wall time [s].
    out, err
        Its standard output and error; of long texts the end.
    """

    why: str
    status: int | None
    seconds: float
    out: str = ""
    err: str = ""

    @property
    def said(self) -> str:
        """Its whole output on the terminal."""
        return self.out + self.err


class Groups:
    """Groups of processes that run, each begun by a program; several threads may start them."""

    def __init__(self) -> None:
        self.is_over = False
        self._running: set[int] = set()
        self._lock = threading.Lock()

    def add(self, group: int) -> None:
        """Note a group that has begun; kill it if all runs are to end."""
        with self._lock:
            self._running.add(group)
        if self.is_over:
            self.end(group)

    def end(self, group: int) -> None:
        """Kill the remaining processes of a group, and forget it."""
        with self._lock, contextlib.suppress(ProcessLookupError, PermissionError):
            self._running.discard(group)
            os.killpg(group, signal.SIGKILL)

    def end_all(self) -> None:
        """Kill all groups that run, and those that begin later."""
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

    The same happens if this process is interrupted meanwhile.

    Parameters
    ----------
    words
        The program and its arguments.
    folder
        Folder of the run.
    environment
        All variables of its environment.
    limit_s
        Time limit [s].
    groups
        Groups of processes that another thread may kill.

    Raises
    ------
    InterruptedError
        Another thread has killed it.
    ProgramError
        It cannot be started, or was ended from outside.
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
            raise ProgramError(
                f"{words[0]}: cannot be started ({error.strerror}); correct the program, or free "
                "memory, and run again to go on"
            ) from None
    why = ""
    status: int | None = None
    groups.add(process.pid)
    try:
        status = process.wait(limit_s)
    except subprocess.TimeoutExpired:
        why = f"it did not end within {limit_s:g} s"
    finally:
        # Processes that it left running are killed, too: they are of its group.
        groups.end(process.pid)
        process.wait()
    if groups.is_over:
        raise InterruptedError("another thread has killed the run")
    if status is not None and -status in FROM_OUTSIDE:
        raise ProgramError(
            f"{words[0]}: ended from outside by signal {-status}; run again to go on"
        )
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
