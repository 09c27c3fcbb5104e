"""Check of the cluster: Slurm, the partition of the profile, the plugin."""

import importlib.metadata
import shutil
import subprocess
from collections.abc import Iterator, Mapping
from typing import Any

from pyrofit.doctor.finding import Level, ReadyLine, Situation

PLUGIN = "snakemake-executor-plugin-slurm"
LONGEST_ANSWER_S = 20.0


def slurm(situation: Situation) -> Iterator[ReadyLine]:
    """Ask `sinfo`; yield nothing if neither a Slurm profile is used nor Slurm is installed."""
    used, program = situation.on_slurm, shutil.which("sinfo")
    if not used and program is None:
        return
    wrong: Level = "error" if used else "warning"
    if program is None:
        text = "the profile is for Slurm, but there is no `sinfo`; run on a login node"
        yield ReadyLine("error", "slurm", text)
        return
    try:
        there = _partitions(program)
    except (OSError, subprocess.SubprocessError) as error:
        text = (
            f"Slurm does not answer ({_reason(error)}); run on a login node, or ask your "
            "administrators"
        )
        yield ReadyLine(wrong, "slurm", text)
        return
    wanted = partition_of(situation.profile)
    if not used:
        text = f"reachable; --profile profiles/slurm checks its partition ({', '.join(there)})"
        yield ReadyLine("ok", "slurm", text)
    elif wanted is not None and wanted not in there:
        text = f"there is no partition '{wanted}'; set slurm_partition to one of {', '.join(there)}"
        yield ReadyLine("error", "slurm", text)
    else:
        yield ReadyLine("ok", "slurm", f"reachable, partition {wanted or 'by default'}")
    if used:
        yield _plugin()


def _plugin() -> ReadyLine:
    try:
        return ReadyLine("ok", "plugin", f"{PLUGIN} {importlib.metadata.version(PLUGIN)}")
    except importlib.metadata.PackageNotFoundError:
        return ReadyLine("error", "plugin", f"{PLUGIN} is not installed; pip install .[slurm]")


def _reason(error: Exception) -> str:
    """Return the last line that a program wrote before it failed, else the error itself."""
    said = getattr(error, "stderr", None) or ""
    text = said.decode(errors="replace") if isinstance(said, bytes) else said
    return (text.strip() or str(error)).splitlines()[-1]


def _partitions(program: str) -> list[str]:
    shown = subprocess.run(
        [program, "--noheader", "--format=%R"],
        capture_output=True,
        text=True,
        check=True,
        timeout=LONGEST_ANSWER_S,
    )
    return sorted(set(shown.stdout.split()))


def partition_of(profile: Mapping[str, Any]) -> str | None:
    """Return the partition of a profile.

    >>> partition_of({"default-resources": {"slurm_partition": "main"}})
    'main'
    >>> partition_of({"default-resources": ["mem_mb=2000", "slurm_partition=long"]})
    'long'
    """
    given = profile.get("default-resources") or {}
    if not isinstance(given, Mapping):
        given = dict(str(item).partition("=")[::2] for item in given)
    found = given.get("slurm_partition")
    return None if found is None else str(found)
