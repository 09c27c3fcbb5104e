"""Pages of the documentation that tests follow: their commands, and a folder to run them in."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tiny import ROOT

LOCK = "requirements.lock"
# That of the tests: its kernels are compiled.
SOURCE = ROOT / "src"
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.M | re.S)
SHOWN = re.compile(r"^```text\n(.*?)^```$", re.M | re.S)


def shown(page: Path) -> list[str]:
    """Return the lines of output on a page; those that it breaks go on with four blanks."""
    blocks = SHOWN.findall(page.read_text(encoding="utf-8"))
    return re.sub(r"\n {4}(?=\S)", " ", "\n".join(blocks)).splitlines()


def copy_project(to: Path) -> None:
    """Copy the files of the project that a run needs, without the source."""
    for folder in ("workflow", "profiles", "config"):
        shutil.copytree(ROOT / folder, to / folder)
    for name in ("Snakefile", "Makefile", "README.md", "LICENSE", "pyproject.toml", LOCK):
        shutil.copy2(ROOT / name, to)


def run(folder: Path, *command: str, source: Path = SOURCE) -> subprocess.CompletedProcess[str]:
    """Run a command that imports the package from a folder."""
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(source),
        "OPENBLAS_NUM_THREADS": "1",
    }
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False
    )


def follow(folder: Path, page: Path) -> subprocess.CompletedProcess[str]:
    """Run all framed commands of a page, one after the other."""
    blocks = BLOCK.findall(page.read_text(encoding="utf-8"))
    assert len(blocks) > 4
    return run(folder, "bash", "-eu", "-o", "pipefail", "-c", "\n".join(blocks))
