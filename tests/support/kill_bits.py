"""Results of a run, byte by byte."""

import hashlib
import re
from pathlib import Path

from tiny import Project

RESULTS = Path("results/tiny")


OF_THE_RUN = ("logs", "benchmarks", "running")
"""Folders whose files may differ between two runs."""


def bits(project: Project) -> dict[str, str]:
    """Return the digests of all results; the wall times that the report tells do not count."""
    root = project.root / RESULTS
    times = re.compile(rb"<li>Wall times of this run.*?</li>")
    return {
        path.relative_to(root).as_posix(): hashlib.sha256(
            times.sub(b"", path.read_bytes()) if path.suffix == ".html" else path.read_bytes()
        ).hexdigest()
        for path in sorted(root.rglob("*"))
        if path.is_file()
        and path.relative_to(root).parts[0] not in OF_THE_RUN
        and not path.name.endswith(".part")
    }
