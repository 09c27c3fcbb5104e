"""The lock of a study's results: one run at a time, and none beside jobs of a former one.

Snakemake's own lock stays behind when a run is killed, and does not cover jobs. Here a run and each
of its jobs write a file that describes their process; files of dead processes are ignored. A job
writes its file before it reads that of the run. A run writes its own before it looks for jobs. Thus
one of the two sees the other.
"""

import atexit
import contextlib
import dataclasses
import json
import os
import threading
import uuid
from collections.abc import Iterator
from pathlib import Path

from pyrofit.errors import RUN, PyrofitError
from pyrofit.results.files import PART, write_json
from pyrofit.running.processes import BEAT_S, Process, is_alive, line_that_ends, this_process

FOLDER = "running"


class RunError(PyrofitError):
    """Another run of the study is alive."""


@dataclasses.dataclass(frozen=True)
class Mark:
    """The file of a run or of a job."""

    path: Path
    token: str
    process: Process


def start_run(root: Path) -> str:
    """Take the lock of a results folder until this process ends, and pass its token to jobs.

    Returns
    -------
    str
        A sentence on the dead run whose lock was taken over, or "".

    Raises
    ------
    RunError
        A run, or a job of a former one, is alive.
    DataError
        The folder cannot be written.
    """
    path = root / FOLDER / "run.json"
    before = _read(path)
    if before is not None and is_alive(before.process, path, beats=True):
        raise RunError(_refusal(root, [before, *_live_jobs(root)]))
    is_stale = before is not None or path.exists()  # after a loss of power it may be damaged
    token = uuid.uuid4().hex
    _put(path, token, before.token if before else "", is_stale)
    atexit.register(end_run, root, token)
    if jobs := _live_jobs(root):
        end_run(root, token)
        raise RunError(_refusal(root, jobs))
    for left in root.rglob(f".*{PART}"):
        left.unlink(missing_ok=True)
    threading.Thread(target=_beat, args=(path, token), daemon=True).start()
    os.environ[RUN] = token
    return f"{root}: the run of {before.process} was broken off; going on" if before else ""


def end_run(root: Path, token: str | None = None) -> None:
    """Delete the lock if this process has it."""
    path = root / FOLDER / "run.json"
    mark = _read(path)
    if mark is not None and mark.token == (token or os.environ.get(RUN)):
        path.unlink(missing_ok=True)
    with contextlib.suppress(OSError):  # where files of jobs are left
        (root / FOLDER).rmdir()


@contextlib.contextmanager
def job(root: Path, by_hand: bool = False) -> Iterator[None]:
    """Count as a job within this context: of the run that the environment names, or of none.

    Parameters
    ----------
    root
        Results folder of the study.
    by_hand
        Whether this is no job of a run whatever the environment names.

    Raises
    ------
    RunError
        The run of this job is over or was replaced; or this is a call by hand, and a run is alive.
    DataError
        The folder cannot be written.
    """
    token = "" if by_hand else os.environ.get(RUN, "")
    path = root / FOLDER / f"job_{uuid.uuid4().hex}.json"
    _write(path, token)
    try:
        run = _read(root / FOLDER / "run.json")
        if token and (run is None or run.token != token):
            raise RunError(f"{root}: the run that this job belongs to is over; nothing was written")
        if not token and run is not None and is_alive(run.process, run.path, beats=True):
            raise RunError(_refusal(root, [run]))
        yield
    finally:
        path.unlink(missing_ok=True)


def join_run(root: Path) -> None:
    """Count as a job of the run that has the lock until this process ends: for jobs of a cluster.

    Raises
    ------
    RunError, DataError
        As `job`.
    """
    run = _read(root / FOLDER / "run.json")
    if RUN not in os.environ and run is not None:  # a cluster that hands on no variables
        os.environ[RUN] = run.token
    here = contextlib.ExitStack()
    here.enter_context(job(root))
    atexit.register(here.close)


def _refusal(root: Path, marks: list[Mark]) -> str:
    lines = [f"    {line_that_ends(m.process)}    # {m.process}" for m in marks]
    ends = "\n".join(lines)
    return (
        f"{root}: another run of this study is alive: {marks[0].process}. Wait for its end, or "
        f"end it with\n{ends}\nIf it does not answer, use kill -9: finished parts are kept. "
        f"If its machine is gone for good, delete {root / FOLDER}"
    )


def _live_jobs(root: Path) -> list[Mark]:
    """Return the jobs that are alive, and delete the files of all others."""
    alive = []
    for path in sorted((root / FOLDER).glob("job_*.json")):
        mark = _read(path)
        if mark is not None and is_alive(mark.process, path, beats=False):
            alive.append(mark)
        else:
            path.unlink(missing_ok=True)
    return alive


def _put(path: Path, token: str, before: str, is_stale: bool) -> None:
    """Write the lock of a run; of two processes that do so one succeeds.

    Parameters
    ----------
    path, token
        The lock, and the token of the run.
    before
        Token of a dead run whose lock is to be replaced, empty if that is damaged.
    is_stale
        Whether there is such a lock.
    """
    fresh = path.with_name(f"run_{token}.json")
    _write(fresh, token)
    stale = path.with_name(f"stale_{token}.json")
    try:
        if is_stale:
            with contextlib.suppress(FileNotFoundError):
                path.rename(stale)
            moved = _read(stale)
            if moved is not None and moved.token != before:  # another process was faster
                with contextlib.suppress(FileExistsError):
                    os.link(stale, path)
        os.link(fresh, path)
    except FileExistsError:
        raise RunError(f"{path.parents[1]}: another run of this study has just started") from None
    finally:
        fresh.unlink(missing_ok=True)
        stale.unlink(missing_ok=True)


def _beat(path: Path, token: str) -> None:
    """Touch the lock as long as it is that of this run."""
    pause = threading.Event()
    while not pause.wait(BEAT_S):
        mark = _read(path)
        if mark is None or mark.token != token:
            return
        with contextlib.suppress(OSError):
            os.utime(path)


def _write(path: Path, token: str) -> None:
    write_json(path, {"token": token, **dataclasses.asdict(this_process())})


def _read(path: Path) -> Mark | None:
    """Return the content of a file; None if it is missing or damaged."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        token = str(content.pop("token"))
        return Mark(path, token, Process(**content))
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return None
