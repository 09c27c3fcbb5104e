"""FDS as a program: its executable, its environment, and its messages."""

import os
import re
import shutil
from pathlib import Path

from pyrofit.errors import ProgramError

VARIABLE = "PYROFIT_FDS"
KEPT = ("PATH", "HOME", "TMPDIR", "LD_LIBRARY_PATH", "I_MPI_ROOT", "FI_PROVIDER_PATH")
"""Variables of the environment that a run gets; none of them changes a result."""
SUCCESS = re.compile(
    r"STOP: (FDS completed successfully|TGA analysis only|FDS performed a TGA analysis only)"
)
LAST = 6
"""Number of last lines that are searched for the one of success."""
NO_FDS = f"no FDS found; set {VARIABLE} to its executable, or have `fds` on the PATH"


def find_fds() -> Path | None:
    """Return the executable that PYROFIT_FDS names, else `fds` of the PATH, else none.

    Raises
    ------
    ProgramError
        PYROFIT_FDS names no executable file.
    """
    named = os.environ.get(VARIABLE)
    if not named:
        found = shutil.which("fds")
        return Path(found).absolute() if found else None
    path = Path(named).expanduser()
    if not (path.is_file() and os.access(path, os.X_OK)):
        raise ProgramError(f"{VARIABLE}={named}: there is no such executable file; correct it")
    return path.absolute()


def fds_environment() -> dict[str, str]:
    """Return the environment of a run."""
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    return {**kept, "OMP_NUM_THREADS": "1"}


def version_in(said: str) -> str:
    """Return the version that FDS prints; empty if it prints none.

    >>> version_in(" Revision         : FDS6.7.4-0-gbfaa110-release")
    '6.7.4'
    """
    found = re.search(r"FDS[- ]?(\d+\.\d+(?:\.\d+)?)", said)
    return found[1] if found else ""


def complaint(said: str, status: int | None) -> str:
    """Return the reason of a failure; empty if the last lines report success.

    Compilers and MPI may add a note after FDS's own last line.

    >>> complaint("ERROR: Problem with SURF", 0)
    'ERROR: Problem with SURF'
    """
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    errors = [line for line in lines if line.startswith("ERROR")]
    if not errors and any(SUCCESS.match(line) for line in lines[-LAST:]):
        return ""
    last = lines[-1] if lines else "it said nothing"
    return errors[0] if errors else f"{last} (exit status {status})"
