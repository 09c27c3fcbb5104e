"""Run FDS with a time limit; its exit status does not count, as it is always 0."""

from pathlib import Path
from typing import NamedTuple

from pyrofit.external.fds import complaint, fds_environment, version_in
from pyrofit.external.process import run_process
from pyrofit_exchange.fds.versions import FdsError

LIMIT_S = 1200.0
"""Time limit of a run."""


class EndedRun(NamedTuple):
    """A run that ended.

    Parameters
    ----------
    why
        The failure; empty where FDS says that it completed.
    seconds
        Wall time.
    said
        Its standard output and error.
    """

    why: str
    seconds: float
    said: str


def call(executable: Path, arguments: list[str], folder: Path, limit_s: float) -> EndedRun:
    """Run FDS in a folder; at the time limit it is killed with all that it started."""
    ended = run_process([str(executable), *arguments], folder, fds_environment(), limit_s)
    why = ended.why or complaint(ended.err, ended.status)
    return EndedRun(why, ended.seconds, ended.said)


def version_text(executable: Path, folder: Path) -> str:
    """Return the version of FDS, such as '6.7.4', from its output without a deck.

    Raises
    ------
    FdsError
        Its version cannot be read.
    """
    run = call(executable, [], folder, 60.0)
    found = version_in(run.said)
    if not found:
        why = run.why or "no Revision line"
        raise FdsError(
            f"{executable}: its version cannot be read ({why}); check that this is FDS's executable"
        )
    return found


def run_deck(
    executable: Path, text: str, name: str, folder: Path, limit_s: float = LIMIT_S
) -> EndedRun:
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
