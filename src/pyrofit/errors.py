"""The errors a user can cause, each with the input, the rule, and the way out."""

from collections.abc import Iterable
from difflib import get_close_matches

INTERRUPTED = "interrupted; run again to go on, finished parts are kept"
"""The line that answers Ctrl-C."""
RUN = "PYROFIT_RUN"
"""Environment variable by which a run of the workflow passes its token to jobs."""

BY_RUN = "PYROFIT_TOLD"
"""Environment variable by which a run asks its jobs to leave the telling of errors to it."""


class PyrofitError(Exception):
    """An error the user can repair; the command line shows its message without a traceback."""


class StudyError(PyrofitError):
    """A study description breaks a rule."""


class DataError(PyrofitError):
    """A measured file breaks a rule."""


class ProgramError(PyrofitError):
    """An external program, or a file of it, cannot be used."""


class CostError(PyrofitError):
    """A cost cannot be computed from these options or this target."""


def suggest(name: str, known: Iterable[str]) -> str:
    """Name the nearest known word and list all of them.

    >>> suggest("back_los", ["back_loss", "ramp"])
    "Did you mean 'back_loss'? Known: back_loss, ramp."
    """
    options = sorted(known)
    near = get_close_matches(name, options, n=1)
    hint = f"Did you mean '{near[0]}'? " if near else ""
    return f"{hint}Known: {', '.join(options)}."
