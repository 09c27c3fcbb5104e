"""Runs of a program: each in a folder of its own, judged, read, and kept."""

import re
import shutil
import signal
import socket
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from pyrofit.errors import DataError
from pyrofit.external.fds import complaint, version_in
from pyrofit.external.filled import (
    Filled,
    environment_of,
    filled_input,
    other_files,
    placeholder_values,
    words_of_command,
)
from pyrofit.external.output import OutputError, WrittenCurve, read_output
from pyrofit.external.process import Ended, Groups, last_lines, run_process
from pyrofit.external.scratch import lay_out, scratch
from pyrofit.external.store import Content, Store, StoredRun
from pyrofit.model.program import Program
from pyrofit.quantities.base import Quantity

Values = Mapping[str, float]
Needed = Mapping[str, float]
"""Last time [s] or temperature [K] at which a value is needed, by signal."""


class Outcome(NamedTuple):
    """How a run ended.

    Parameters
    ----------
    records
        Curves by signal; empty if the run failed.
    why
        Reason of a failure; empty if there is none.
    seconds
        Wall time [s] of a run that succeeded, also of an earlier one.
    version
        Version that the program prints, if it does.
    """

    records: Mapping[str, WrittenCurve]
    why: str = ""
    seconds: float = 0.0
    version: str = ""


class _Task(NamedTuple):
    """A run that is to be made."""

    program: Program
    quantities: Mapping[str, Quantity]
    needed: Needed
    values: Values
    filled: Filled


def outcomes(
    program: Program,
    quantities: Mapping[str, Quantity],
    needed: Needed,
    sets: Sequence[Values],
    again: bool = False,
) -> list[Outcome]:
    """Return the outcomes for some parameter sets; runs that are kept are not repeated.

    Parameters
    ----------
    program
        The program.
    quantities
        Quantities that are read, by signal.
    needed
        Last time or temperature that each curve must reach.
    sets
        Parameter values in SI units by name, of each set.
    again
        Whether a run that failed before is repeated.

    Raises
    ------
    ProgramError
        The program or a file that it needs is missing, or it cannot be run.
    """
    store = Store(program.store)
    found: dict[str, Outcome] = {}
    keys: list[str] = []
    waiting: dict[str, _Task] = {}
    for number, values in enumerate(sets):
        try:
            task = _Task(program, quantities, needed, values, filled_input(program, values))
        except ValueError as error:
            keys.append(f"set {number}")
            found[keys[-1]] = Outcome({}, str(error))
            continue
        key = task.filled.key
        keys.append(key)
        known = found.get(key) or _known(store, task, again)
        if known is None:
            waiting[key] = task
        else:
            found[key] = known
    found |= _run_all(store, waiting, program.parallel)
    return [found[key] for key in keys]


def _known(store: Store, task: _Task, again: bool) -> Outcome | None:
    """Return the outcome of a run that was made before; None if there is none."""
    known = store.known(task.filled.key)
    if known is not None:
        short = _short(known.records, task.needed)
        return Outcome({}, short) if short else _success(known)
    failure = None if again else store.failure(task.filled.key)
    if failure is None:
        return None
    # It may succeed with more time, or if less is needed.
    more_time = failure.get("time_limit_s", task.program.time_limit_s) < task.program.time_limit_s
    less = any(task.needed.get(s, 0.0) < t for s, t in failure.get("needed", {}).items())
    return None if more_time or less else Outcome({}, failure["why"])


def _run_all(store: Store, tasks: Mapping[str, _Task], parallel: int) -> dict[str, Outcome]:
    """Make runs, several of them at once."""
    if not tasks:
        return {}
    groups = Groups()
    with scratch() as folder:
        if parallel == 1 or len(tasks) == 1:
            return {key: _run(store, task, folder, groups) for key, task in tasks.items()}
        with ThreadPoolExecutor(min(parallel, len(tasks))) as pool:
            futures = {k: pool.submit(_run, store, t, folder, groups) for k, t in tasks.items()}
            try:
                return {key: future.result() for key, future in futures.items()}
            except BaseException:
                for future in futures.values():
                    future.cancel()
                groups.end_all()
                raise


def _run(store: Store, task: _Task, scratch_folder: Path, groups: Groups) -> Outcome:
    """Make a run in a folder of its own, and keep its curves or its failure."""
    program, key = task.program, task.filled.key
    folder = scratch_folder / key
    ended = _ended(task, folder, groups)
    if ended.status == -signal.SIGKILL:
        # Memory ran out, or somebody killed it: that says little of the set.
        shutil.rmtree(folder)
        ended = _ended(task, folder, groups)
    why = judged(program, ended)
    records: dict[str, WrittenCurve] = {}
    if not why:
        try:
            records = _read(task, folder)
            why = _short(records, task.needed)
        except (OutputError, DataError) as error:
            why = str(error)
    if not why:
        made = StoredRun(records, ended.seconds, version_in(ended.said))
        store.keep(key, made)
        shutil.rmtree(folder, ignore_errors=True)
        # The record of a faster process counts, if the two differ.
        return _success(store.known(key) or made)
    store.fail(key, _failure(task, ended, why, bool(records)), folder, program.keep_failed)
    shutil.rmtree(folder, ignore_errors=True)
    return Outcome({}, why)


def _ended(task: _Task, folder: Path, groups: Groups) -> Ended:
    """Run the program in a new folder until it ends."""
    program = task.program
    lay_out(folder, {program.input_name: task.filled.content, **other_files(program)})
    return run_process(
        words_of_command(program), folder, environment_of(program), program.time_limit_s, groups
    )


def _success(known: StoredRun) -> Outcome:
    return Outcome(known.records, "", known.seconds, known.version)


def _read(task: _Task, folder: Path) -> dict[str, WrittenCurve]:
    return {
        name: read_output(folder, reading, task.quantities[name])
        for name, reading in task.program.reads.items()
    }


def judged(program: Program, ended: Ended) -> str:
    """Return the reason of a failure by status and messages of a program; empty if it succeeded."""
    if ended.why:
        return ended.why
    if program.dialect == "fds":
        return complaint(ended.err, ended.status)
    if ended.status == -signal.SIGKILL:
        return "it was killed twice, perhaps for lack of memory"
    if ended.status is not None and ended.status < 0:
        return f"it was ended by signal {-ended.status}"
    if ended.status:
        return f"exit status {ended.status}"
    if program.fails and (found := re.search(program.fails, ended.said, re.MULTILINE)):
        return f"it says '{found[0].strip()}'"
    if program.succeeds and not re.search(program.succeeds, ended.said, re.MULTILINE):
        return f"it does not say '{program.succeeds}'"
    return ""


def _short(records: Mapping[str, WrittenCurve], needed: Needed) -> str:
    """Name a curve that ends before the needed value by more than its last step."""
    for name, last in needed.items():
        at = records[name].at
        step = float(at[-1] - at[-2]) if at.size > 1 else 0.0
        if float(at[-1]) + step < last:
            return f"{name} ends at {float(at[-1]):g}, and is needed until {last:g}"
    return ""


def _failure(task: _Task, ended: Ended, why: str, is_short: bool) -> Content:
    """Return the record of a failure."""
    units = task.program.units
    values = placeholder_values(task.program, task.values)
    content: Content = {
        "why": why,
        "exit_status": ended.status,
        "seconds": round(ended.seconds, 3),
        "placeholders": {n: {"value": v, "unit": units.get(n, "")} for n, v in values.items()},
        "last_lines": last_lines(ended.out) + last_lines(ended.err),
        "command": list(task.program.command),
        "node": socket.gethostname(),
    }
    if ended.why:
        content["time_limit_s"] = task.program.time_limit_s
    if is_short:
        content["needed"] = dict(task.needed)
    return content
