"""The software in an archive: pyrofit with its workflow, and the versions of all packages."""

import importlib.metadata
from collections.abc import Iterator
from pathlib import Path

from packaging.requirements import Requirement

PACKAGE = Path(__file__).parent
LOCK = "requirements.lock"
VERSIONS = "requirements.txt"
"""Versions of an environment that no lock file has made."""
_PROJECT = (
    "CITATION.cff",
    "Dockerfile",
    "LICENSE",
    "Makefile",
    "README.md",
    "Snakefile",
    "pyproject.toml",
    LOCK,
    "config/*.yaml",
    "config/templates/*",
    "profiles/*/config.yaml",
    "workflow/**/*",
)


def is_project(folder: Path) -> bool:
    """Return whether a folder is a copy of the repository, with lock file and Makefile."""
    return all((folder / name).is_file() for name in ("Snakefile", LOCK))


def software(project: Path) -> dict[str, bytes]:
    """Return the files needed to run a study again, by name.

    Parameters
    ----------
    project
        A copy of the repository, all of whose files are taken. In any other folder the package is
        taken, and the versions of this environment stand for the lock file.
    """
    entries = {
        f"src/{path.relative_to(PACKAGE.parent).as_posix()}": path.read_bytes()
        for folder in (PACKAGE, *(p.parent for p in PACKAGE.parent.glob("pyrofit_*/__init__.py")))
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    if not is_project(project):
        lines = "".join(f"{name}=={version}\n" for name, version in sorted(versions("pyrofit")))
        return entries | {VERSIONS: lines.encode()}
    found = (path for pattern in _PROJECT for path in project.glob(pattern) if path.is_file())
    return entries | {path.relative_to(project).as_posix(): path.read_bytes() for path in found}


def versions(package: str) -> set[tuple[str, str]]:
    """Return names and versions of all that a package requires, at whatever distance."""
    found: dict[str, str] = {}
    ahead = [*_required(package)]
    while ahead:
        name = ahead.pop()
        if name not in found:
            found[name] = importlib.metadata.version(name)
            ahead += _required(name)
    return set(found.items())


def _required(package: str) -> Iterator[str]:
    for line in importlib.metadata.requires(package) or ():
        requirement = Requirement(line)
        if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
            yield requirement.name.lower().replace("_", "-")
