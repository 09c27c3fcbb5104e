"""Why jobs of a Slurm cluster failed, as their logs tell: Snakemake shows only a part of them."""

import re
from collections.abc import Collection, Iterator
from pathlib import Path

LOGS = Path(".snakemake/slurm_logs")
"""Where the plugin keeps the logs of jobs that failed, in a folder for each rule."""
CAUSES = {
    r"exceeded memory limit|exceeded job memory|oom.?kill|out.of.memory": (
        "needed more memory than it had asked for; raise its mem_mb in the profile"
    ),
    r"due to time limit": "ran longer than it had asked for; raise its runtime in the profile",
    r"due to node failure|node_fail": "lost its node; run again",
    r"cancelled at": "was cancelled; run again",
}
"""Words of Slurm, in lower case, and their meaning; the first that fit count."""


def logs() -> set[Path]:
    """Return the logs of failed jobs that are there."""
    return set(LOGS.rglob("*.log"))


def causes(before: Collection[Path]) -> Iterator[str]:
    """Yield a sentence on each job that failed for a cause of the cluster.

    Parameters
    ----------
    before
        Logs of earlier runs.
    """
    for path in sorted(logs() - set(before)):
        text = path.read_text(encoding="utf-8", errors="replace").lower()
        found = [meaning for words, meaning in CAUSES.items() if re.search(words, text)]
        if found:
            job = path.relative_to(LOGS).parts[0].partition("_")[2]
            yield f"{job} (Slurm job {path.stem}) {found[0]}"
