"""The origin of a result: fingerprints of the source, versions, checksums."""

import hashlib
import importlib.metadata
import os
import platform
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from pyrofit.sources import keep_digests, source_of
from pyrofit.steps import known_steps

PACKAGES = (
    "jinja2",
    "matplotlib",
    "numba",
    "numpy",
    "pandas",
    "pydantic",
    "scipy",
    "snakemake",
    "spotpy",
)
NUMERIC = ("numba", "numpy", "pandas", "scipy", "spotpy")
"""Packages whose version may change a number."""
STUDY = (
    *(
        f"pyrofit.stages.{step}"
        for step in (
            "measurements",
            "fit",
            "identify",
            "isoconversional",
            "predict",
            "compare",
            "diagnose",
        )
    ),
    "pyrofit.show.report",
    *(module for step in known_steps().values() for module in step.modules),
)
"""Modules of all steps of a study."""
FINDERS = frozenset({"pyrofit.discovery.contents", "pyrofit.show.section.section_of"})
"""Functions by which a package finds its files without importing them by name; all count."""
BY_USE = ("pyrofit.effects", "pyrofit.steps")
"""Packages of which only the used files count, see `results.dependencies`."""


def source_fingerprint(*modules: str) -> str:
    """Return a hash of the code of some modules, of the data registry and numeric packages.

    Whatever they import of pyrofit counts as well, at whatever distance, with the files beside it
    that are no Python. Comments and docstrings do not count. Snakemake does not notice an edit to
    an imported package: rules carry this as a parameter.

    Parameters
    ----------
    modules
        Full names, such as ``pyrofit.stages.fit``.
    """
    root = Path(__file__).parent
    total = hashlib.sha256()
    for package in NUMERIC:
        total.update(f"{package} {_version(package)}".encode())
    sources = _reached(_modules_here(root), modules)
    folders = {path.parent for path in sources}
    beside = {p for folder in folders for p in folder.iterdir() if p.suffix in (".j2", ".txt")}
    for path in sorted(sources | beside):
        total.update(path.relative_to(root).as_posix().encode())
        total.update(source_of(path).digest.encode())
    keep_digests()
    return total.hexdigest()[:16]


_version = cache(importlib.metadata.version)


def imported_files(root: Path, modules: Iterable[str]) -> set[Path]:
    """Return the files of the package in ``root`` that modules are made of and import.

    Imports anywhere in a file count, those for type checks alone included; so do the packages
    around a module, which are imported with it.

    Raises
    ------
    ValueError
        There is no such module.
    """
    return _reached(_files_by_module(root), modules)


def _reached(files: Mapping[str, Path], modules: Iterable[str]) -> set[Path]:
    ahead = list(modules)
    if unknown := [name for name in ahead if name not in files]:
        raise ValueError(f"there is no module {', '.join(unknown)}")
    found: set[Path] = set()
    while ahead:
        name = ahead.pop()
        path = files.get(name)
        if path in found:
            continue
        if path is not None:  # else a name in a module
            found.add(path)
            ahead += source_of(path).imports
            ahead += _catalogue(name, files)
        ahead += [name.rpartition(".")[0]] if "." in name else []
    return found


def _files_by_module(root: Path) -> dict[str, Path]:
    files = {}
    for folder, _, names in os.walk(root):
        of = ".".join((root.name, *Path(folder).relative_to(root).parts))
        for name in names:
            if name.endswith(".py"):
                module = of if name == "__init__.py" else f"{of}.{name[:-3]}"
                files[module] = Path(folder, name)
    return files


_modules_here = cache(_files_by_module)
"""Modules of a folder as they are at the first call: a plan takes many fingerprints."""


def _catalogue(package: str, files: Mapping[str, Path]) -> list[str]:
    """Return the modules of a package that finds all of them."""
    path = files[package]
    finds = path.name == "__init__.py" and source_of(path).imports & FINDERS
    if not finds or package in BY_USE:
        return []
    return [name for name in files if name.rpartition(".")[0] == package]


def environment() -> dict[str, Any]:
    """Return the versions that a result depends on."""
    versions = {name: importlib.metadata.version(name) for name in ("pyrofit", *PACKAGES)}
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        "packages": versions,
        "source_fingerprint": source_fingerprint(*STUDY),
    }
