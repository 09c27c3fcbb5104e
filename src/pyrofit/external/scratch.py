"""Folders in which programs run: on the disk of the node, one for each run, removed afterwards.

A process that is killed leaves its folder. The next one finds that nobody holds its lock any more,
kills the programs that still run there, and removes it.
"""

import contextlib
import os
import shutil
import signal
import socket
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from pyrofit.errors import ProgramError

if sys.platform != "win32":
    import fcntl

VARIABLE = "PYROFIT_SCRATCH"
PREFIX = "pyrofit-runs-"
LOCK = "owner.lock"


def scratch_root() -> Path:
    """Return the folder that PYROFIT_SCRATCH names, else that of the system, TMPDIR."""
    return Path(os.environ.get(VARIABLE) or tempfile.gettempdir())


@contextlib.contextmanager
def scratch() -> Iterator[Path]:
    """Make a folder for the runs of this process, locked, and remove it at the end.

    Raises
    ------
    ProgramError
        The system has no locks, or the folder cannot be written.
    """
    if sys.platform == "win32":  # nor can it kill a program with all that it started
        raise ProgramError("external programs need Linux or macOS; on Windows use WSL")
    root = scratch_root()
    with _written(root):
        root.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix=f"{_own_prefix()}{os.getpid()}-", dir=root))
        unnamed = folder / f"new_{LOCK}"
        lock = unnamed.open("w")
        fcntl.flock(lock, fcntl.LOCK_EX)
        unnamed.rename(folder / LOCK)  # locked before `sweep_scratch` can find it
    with lock:
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


def lay_out(folder: Path, files: Mapping[str, bytes]) -> None:
    """Make the folder of a run with its files.

    Raises
    ------
    ProgramError
        There is no room.
    """
    with _written(folder):
        folder.mkdir()
        for name, content in files.items():
            (folder / name).write_bytes(content)


@contextlib.contextmanager
def _written(folder: Path) -> Iterator[None]:
    """Turn a fault of the disk into a message."""
    try:
        yield
    except OSError as error:
        raise ProgramError(
            f"{folder}: cannot be written ({error.strerror}); make room, or set {VARIABLE} to a "
            "folder on another disk"
        ) from None


def sweep_scratch() -> int:
    """Remove the folders that killed processes of this node have left; return their number."""
    removed = 0
    if sys.platform == "win32":
        return removed
    for folder in scratch_root().glob(f"{_own_prefix()}*"):
        with contextlib.suppress(OSError), (folder / LOCK).open("r+") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue  # its owner lives
            _end_processes_in(folder)
            shutil.rmtree(folder, ignore_errors=True)
            removed += 1
    return removed


def _own_prefix() -> str:
    """Return the beginning of the names of folders of this user on this node."""
    return f"{PREFIX}{os.getuid()}-{socket.gethostname()}-"


def _end_processes_in(folder: Path) -> None:
    """Kill the processes whose working folder lies in a folder, if the system shows them."""
    here = str(folder.resolve())
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            where = os.readlink(process / "cwd")
            if where == here or where.startswith(here + os.sep):
                os.kill(int(process.name), signal.SIGKILL)
