"""FDS as a program: found, run with a time limit, and never believed by its exit status."""

import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

from pyrofit.exchange.fds.versions import FdsError

VARIABLE = "PYROFIT_FDS"
LIMIT_S = 1200.0
"""Time limit of a run."""
KEPT = ("PATH", "HOME", "TMPDIR", "LD_LIBRARY_PATH", "I_MPI_ROOT", "FI_PROVIDER_PATH")
"""Variables of the environment that a run gets: those that change a result are not among them."""
SUCCESS = re.compile(
    r"STOP: (FDS completed successfully|TGA analysis only|FDS performed a TGA analysis only)"
)
LAST = 6
"""Lines at the end among which that of success is."""
NO_FDS = f"no FDS found; set {VARIABLE} to its executable, or have `fds` on the PATH"


class Run(NamedTuple):
    """A run that ended.

    Parameters
    ----------
    why
        What went wrong; empty where FDS says that it completed.
    seconds
        Wall time.
    said
        What it wrote to standard output and error.
    """

    why: str
    seconds: float
    said: str


def find_fds() -> Path | None:
    """Return the executable that PYROFIT_FDS names, else `fds` of the PATH, else none.

    Raises
    ------
    FdsError
        PYROFIT_FDS names no executable file.
    """
    named = os.environ.get(VARIABLE)
    if not named:
        found = shutil.which("fds")
        return Path(found) if found else None
    path = Path(named).expanduser()
    if not (path.is_file() and os.access(path, os.X_OK)):
        raise FdsError(f"{VARIABLE}={named}: there is no such executable file; correct it")
    return path.resolve()


def call(executable: Path, arguments: list[str], folder: Path, limit_s: float) -> Run:
    """Run FDS in a folder; what has not ended in time is killed with all that it started."""
    environment = {name: os.environ[name] for name in KEPT if name in os.environ}
    environment["OMP_NUM_THREADS"] = "1"
    begin = time.monotonic()
    try:
        process = subprocess.Popen(
            [str(executable), *arguments],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            start_new_session=True,
        )
    except OSError as error:
        return Run(f"it cannot be started ({error.strerror})", 0.0, "")
    try:
        out, errors = process.communicate(timeout=limit_s)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        out, errors = process.communicate()
        return Run(f"it did not end within {limit_s:g} s", time.monotonic() - begin, out + errors)
    return Run(_complaint(errors, process.returncode), time.monotonic() - begin, out + errors)


def _complaint(said: str, status: int) -> str:
    """Return why a run failed; empty where its last lines tell of success.

    Compilers and MPI may add a note behind FDS's own last line.

    >>> _complaint("ERROR: Problem with SURF", 0)
    'ERROR: Problem with SURF'
    """
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    errors = [line for line in lines if line.startswith("ERROR")]
    if not errors and any(SUCCESS.match(line) for line in lines[-LAST:]):
        return ""
    last = lines[-1] if lines else "it said nothing"
    return errors[0] if errors else f"{last} (exit status {status})"


def version_text(executable: Path, folder: Path) -> str:
    """Return the version of FDS, such as '6.7.4', from what it says without a deck.

    Raises
    ------
    FdsError
        It does not say its version.
    """
    run = call(executable, [], folder, 60.0)
    found = re.search(r"FDS[- ]?(\d+\.\d+(?:\.\d+)?)", run.said)
    if found is None:
        why = run.why or "no Revision line"
        raise FdsError(f"{executable}: it does not say its version ({why}); is it FDS?")
    return found[1]


def run_deck(executable: Path, text: str, name: str, folder: Path, limit_s: float = LIMIT_S) -> Run:
    """Run a deck in a new folder.

    Parameters
    ----------
    executable
        FDS.
    text, name
        Content of the deck, and its CHID.
    folder
        Where it runs; a file ``<name>.stop`` left there would stop it at once.
    limit_s
        Time limit [s].
    """
    (folder / f"{name}.stop").unlink(missing_ok=True)
    (folder / f"{name}.fds").write_text(text, encoding="ascii")
    return call(executable, [f"{name}.fds"], folder, limit_s)
