"""Processes that work on a study: their description, whether they are alive, how to end them."""

import getpass
import os
import socket
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

BEAT_S = 5.0
"""Time between two touches of a run's lock."""
SILENCE_S = 4 * BEAT_S
"""A run of another machine that does not touch its lock for so long is gone."""
STATES_ALIVE = ("PENDING", "CONFIGURING", "RUNNING", "SUSPENDED", "COMPLETING")
"""States of Slurm jobs whose processes run now or later."""
HIDDEN = "unknown"
"""Start of a process that exists, but whose start is not shown."""


@dataclass(frozen=True)
class Process:
    """A process as its lock describes it.

    Parameters
    ----------
    host, user, pid
        For people.
    machine
        Boot of the operating system and its space of process numbers. If both are equal, the
        number identifies a process.
    started
        Start of the process, as the system counts it, because numbers are used again.
    slurm_job
        The Slurm job that it belongs to, or "".
    """

    host: str
    user: str
    pid: int
    machine: str
    started: str
    slurm_job: str

    def __str__(self) -> str:
        job = f", Slurm job {self.slurm_job}" if self.slurm_job else ""
        return f"process {self.pid} of {self.user} on {self.host}{job}"


def this_process() -> Process:
    """Return this process."""
    pid = os.getpid()
    return Process(
        host=socket.gethostname(),
        user=_user(),
        pid=pid,
        machine=_machine(),
        started=_started(pid),
        slurm_job=os.environ.get("SLURM_JOB_ID", ""),
    )


def is_alive(process: Process, mark: Path, beats: bool) -> bool:
    """Return whether a process lives.

    Parameters
    ----------
    process
        The process.
    mark
        Its file, which it touches every `BEAT_S` seconds if it ``beats``.

    No clock is compared with another one. A process that cannot be looked up counts as alive.
    """
    if process.machine == _machine():
        return _started(process.pid) in (process.started, HIDDEN)
    if process.slurm_job and (told := _slurm_says(process.slurm_job)) is not None:
        return told
    return _touched(mark) if beats else True


def line_that_ends(process: Process) -> str:
    """Return a command that ends a process."""
    if process.slurm_job:
        return f"scancel {process.slurm_job}"
    if process.machine == _machine():
        return f"kill {process.pid}"
    return f"ssh {process.host} kill {process.pid}"


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):  # a number without a name, in containers
        return str(os.getuid())


def _machine() -> str:
    try:
        boot = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
        return f"{boot} {os.readlink('/proc/self/ns/pid')}"
    except OSError:  # not Linux
        return socket.gethostname()


def _started(pid: int) -> str:
    """Return the start of a process of this machine; "" if there is none."""
    try:
        # The name, in brackets, may hold anything. Then come the state and 18 numbers.
        state, *numbers = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return _answers(pid)  # there is none, or it is hidden, as those of other users may be
    return "" if state in "ZX" else numbers[18]


def _answers(pid: int) -> str:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return ""
    except OSError:  # of another user
        pass
    return HIDDEN


def _slurm_says(job: str) -> bool | None:
    """Return whether Slurm knows a job that has not ended; None if it cannot be asked."""
    try:
        asked = subprocess.run(
            ["squeue", "--noheader", "--jobs", job, "--format", "%T"],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    if asked.returncode:
        return False if "Invalid job id" in asked.stderr else None
    return any(s in asked.stdout for s in STATES_ALIVE)


def _touched(mark: Path) -> bool:
    """Return whether a file is touched while this process looks at it."""
    before, give_up = _stamp(mark), time.monotonic() + SILENCE_S
    while time.monotonic() < give_up:
        time.sleep(BEAT_S / 5)
        if _stamp(mark) != before:
            return True
    return False


def _stamp(mark: Path) -> int:
    """Return the time stamp of a file; opened, because network file systems keep old ones."""
    try:
        with mark.open("rb") as file:
            return os.fstat(file.fileno()).st_mtime_ns
    except OSError:
        return 0
