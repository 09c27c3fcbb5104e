"""The origin of a result: fingerprints of the source, versions, checksums."""

import hashlib
import importlib.metadata
import importlib.util
import os
import platform
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from pyrofit.discovery import added
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
    *(page.module for page in added("pages").values()),
    *(module for step in known_steps().values() for module in step.modules),
)
"""Modules of all steps of a study."""
FINDERS = frozenset(
    {
        "pyrofit.discovery.catalogue",
        "pyrofit.discovery.contents",
        "pyrofit.show.page.page_of_folder",
    }
)
"""Functions by which a package finds its files without importing them by name; all count."""
FINDER_OF_FOLDERS = "pyrofit.discovery.rooms"
"""Function by which a module finds the folders in a package that it imports; all count."""
BY_USE = ("pyrofit.effects", "pyrofit.steps")
"""Packages of which only the used files count, see `results.dependencies`."""


def source_fingerprint(*modules: str) -> str:
    """Return a hash of the code of some modules, of the data registry and numeric packages.

    Whatever they import of their own packages, of pyrofit and of the packages ``pyrofit_*`` counts
    as well, at whatever distance. So do the files beside it that are no Python. Comments and
    docstrings do not count. Snakemake does not notice an edit to an imported package: this is among
    the inputs of a rule.

    Parameters
    ----------
    modules
        Full names, such as ``pyrofit.stages.fit``.
    """
    total = hashlib.sha256()
    for package in NUMERIC:
        total.update(f"{package} {_version(package)}".encode())
    reached = _reached(Path(__file__).parent, modules, _modules_here)
    folders = {
        path.parent: name if path.name == "__init__.py" else name.rpartition(".")[0]
        for name, path in reached.items()
    }
    beside = {
        f"{name}/{p.name}": p
        for folder, name in folders.items()
        for p in folder.iterdir()
        if p.suffix in (".j2", ".txt")
    }
    for name, path in sorted((reached | beside).items()):
        total.update(name.encode())
        total.update(source_of(path).digest.encode())
    keep_digests()
    return total.hexdigest()[:16]


_version = cache(importlib.metadata.version)


def imported_files(root: Path, modules: Iterable[str]) -> set[Path]:
    """Return the files that modules are made of and import.

    Imports anywhere in a file count, those for type checks alone included; so do the packages
    around a module, which are imported with it.

    Parameters
    ----------
    root
        Folder of pyrofit; its other packages lie beside it.
    modules
        Full names.

    Raises
    ------
    ValueError
        There is no such module.
    """
    return set(_reached(root, modules, _files_by_module).values())


def _reached(
    root: Path, modules: Iterable[str], files_in: Callable[[Path], Mapping[str, Path]]
) -> dict[str, Path]:
    """Return the files that modules are made of and import, by the full names of the modules."""
    wanted = list(modules)
    ahead = wanted.copy()
    packages = {root.name, *(name.partition(".")[0] for name in wanted)}
    files: dict[str, Path] = {}
    read: set[str] = set()
    found: dict[str, Path] = {}
    while ahead:
        name = ahead.pop()
        package = name.partition(".")[0]
        if name in found or not (package in packages or package.startswith(f"{root.name}_")):
            continue
        if package not in read:
            read.add(package)
            files.update(files_in(_folder(root, package)))
        path = files.get(name)
        if path is not None:  # else a name in a module
            found[name] = path
            ahead += source_of(path).imports
            ahead += _catalogue(name, files)
        ahead += [name.rpartition(".")[0]] if "." in name else []
    if unknown := [name for name in wanted if name not in found]:
        raise ValueError(f"there is no module {', '.join(unknown)}")
    return found


def _folder(root: Path, package: str) -> Path:
    """Return the folder of a package: pyrofit's, one beside it, or elsewhere."""
    beside = root.parent / package
    if beside.is_dir():
        return beside
    spec = importlib.util.find_spec(package)
    places = spec.submodule_search_locations if spec is not None else None
    return Path(next(iter(places))) if places else beside


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
    """Return the modules of a package that finds all of them, or the folders that one finds."""
    path = files[package]
    imports = source_of(path).imports
    if FINDER_OF_FOLDERS in imports:
        folders = (name for name, file in files.items() if file.name == "__init__.py")
        return [name for name in folders if name.rpartition(".")[0] in imports]
    finds = path.name == "__init__.py" and imports & FINDERS
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
