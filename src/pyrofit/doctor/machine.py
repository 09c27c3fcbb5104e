"""Checks of the machine: versions, cache of compiled code, cores, memory, disk."""

import importlib.metadata
import os
import platform
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

from pyrofit.doctor.finding import ReadyLine, Situation, size, writable
from pyrofit.doctor.plan import parts_of, size_of_results
from pyrofit.provenance import PACKAGES

JOB_BYTES = 700e6
"""Memory of one job; at most 645 MB were measured."""
SNAKEMAKE_BYTES = 300e6
"""Memory of Snakemake itself; 266 MB were measured with 1000 repetitions."""
LEAST_FREE = 0.5e9
"""Disk space below which there is a warning if no study is given."""


def check_versions(situation: Situation) -> Iterator[ReadyLine]:
    """Compare the installed packages with those of requirements.lock."""
    installed: dict[str, str] = {}
    for name in PACKAGES:
        try:
            installed[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            yield ReadyLine("error", "versions", f"{name} is not installed; {_INSTALL}")
    lock = situation.project / "requirements.lock"
    if not lock.is_file():
        if len(installed) == len(PACKAGES):
            text = f"Python {platform.python_version()}, packages as installed, not as locked"
            yield ReadyLine("ok", "versions", f"{text}: last digits may differ on other machines")
        return
    # A package has several lines if its version depends on that of Python.
    locked: dict[str, list[str]] = {}
    for name, version in re.findall(
        r"^([\w.-]+)==([^\s;]+)", lock.read_text(encoding="utf-8"), re.M
    ):
        locked.setdefault(name, []).append(version)
    other = [
        f"{name} {version} (locked: {' or '.join(locked[name])})"
        for name, version in installed.items()
        if version not in locked.get(name, [version])
    ]
    if other:
        text = f"{', '.join(other)}: last digits of results may differ; {_INSTALL}"
        yield ReadyLine("warning", "versions", text)
    elif len(installed) == len(PACKAGES):
        text = f"Python {platform.python_version()}, packages as in requirements.lock"
        yield ReadyLine("ok", "versions", text)


_INSTALL = "`make .venv/installed` installs the locked versions"


def cache(situation: Situation) -> Iterator[ReadyLine]:
    """Try to write in the folders of compiled code."""
    from pyrofit.compiled.cache import folders

    wrong = {folder: writable(folder) for folder in folders()}
    for folder, reason in wrong.items():
        if not reason:
            yield ReadyLine("ok", "cache", f"compiled code can be kept in {folder}")
            return
    tried = ", ".join(f"{folder} ({reason})" for folder, reason in wrong.items())
    yield ReadyLine(
        "error",
        "cache",
        f"compiled code cannot be kept; every job would compile for a minute: {tried}; make room, "
        "or set NUMBA_CACHE_DIR to a folder that can be written",
    )


def check_cores(situation: Situation) -> Iterator[ReadyLine]:
    """Compare the number of jobs at once with the cores, and with the jobs of the study."""
    there, asked = available_cores(), situation.cores
    if situation.on_slurm:
        yield ReadyLine("ok", "cores", f"{asked} Slurm jobs at once; {there} cores on this machine")
        return
    if asked > there:
        text = f"{asked} jobs at once on {there} cores slow each other down; use --cores {there}"
        yield ReadyLine("warning", "cores", text)
        return
    study = situation.study
    jobs = sum(part.jobs for part in parts_of(study, asked)) if study else asked
    if jobs < asked:
        text = f"{asked} of {there} cores; the fits have {jobs} jobs, so that some stay idle"
    else:
        text = f"{asked} of {there} cores are used"
    yield ReadyLine("ok", "cores", text)


def memory(situation: Situation) -> Iterator[ReadyLine]:
    """Compare the memory of all jobs at once with the available memory."""
    jobs = 1 if situation.on_slurm else situation.cores
    need = SNAKEMAKE_BYTES + jobs * JOB_BYTES
    there = available_memory()
    if there is None:
        text = f"{size(need)} are needed; the available memory is unknown on this system"
        yield ReadyLine("warning", "memory", text)
    elif there < need:
        fit = int((there - SNAKEMAKE_BYTES) // JOB_BYTES)
        way_out = f"use --cores {fit}" if fit >= 1 else "end other programs"
        text = f"{size(there)} available, {jobs} jobs at once need {size(need)}; {way_out}"
        yield ReadyLine("error", "memory", text)
    else:
        yield ReadyLine("ok", "memory", f"{size(there)} available, {size(need)} needed")


def disk(situation: Situation) -> Iterator[ReadyLine]:
    """Try to write in the results folder, and compare its free space with the study's results."""
    folder = situation.results
    while not folder.exists():
        folder = folder.parent
    if reason := writable(folder):
        way_out = "change its rights, or run in a folder of your own"
        yield ReadyLine("error", "disk", f"{folder}: cannot be written ({reason}); {way_out}")
        return
    free = free_bytes(folder)
    if situation.study is None:
        tight = free < LEAST_FREE
        text = f"{size(free)} free{'; make room before you run a study' if tight else ''}"
        yield ReadyLine("warning" if tight else "ok", "disk", text)
        return
    need = size_of_results(situation.study)
    there = f"{size(free)} free for {situation.results}, about {size(need)} will be written"
    if free < need:
        text = f"{there}; make room, or run in a folder on another disk"
        yield ReadyLine("error", "disk", text)
    else:
        yield ReadyLine("ok", "disk", there)


def available_cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def available_memory() -> float | None:
    """Return the memory that programs can still take [byte]; None if it is unknown."""
    try:
        text = Path("/proc/meminfo").read_text(encoding="ascii")
    except OSError:
        return None
    found = re.search(r"^MemAvailable:\s+(\d+) kB", text, re.M)
    return 1024.0 * int(found[1]) if found else None


def free_bytes(folder: Path) -> float:
    """Return the free space of the disk that a folder is on [byte]."""
    return float(shutil.disk_usage(folder).free)
