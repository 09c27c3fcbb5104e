"""A user's own effects, quantities and costs, from the folders under ``plugins`` of a study."""

import hashlib
import importlib
import inspect
import pkgutil
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from pyrofit.cost import KINDS
from pyrofit.discovery import added
from pyrofit.effects.base import Effect
from pyrofit.quantities.base import Quantity
from pyrofit.sources import source_of

HELPER = "_"
"""Beginning of the names of files that define nothing themselves, but that others import."""


@dataclass(frozen=True)
class Catalogue:
    """Content of a subfolder of a plugin folder."""

    package: str
    """Package of pyrofit that finds its files."""
    attribute: str
    """Name that each file defines."""
    form: str
    """How it is written."""
    fits: Callable[[Any], bool]


def _is_cost(made: object) -> bool:
    """Tell whether something is a function of a target and of options by keyword."""
    if not inspect.isfunction(made):
        return False
    kinds = [parameter.kind for parameter in inspect.signature(made).parameters.values()]
    options = {inspect.Parameter.KEYWORD_ONLY}
    return bool(kinds) and kinds[0] not in options and set(kinds[1:]) <= options


CATALOGUES = {
    "effects": Catalogue(
        "pyrofit.effects", "EFFECT", "EFFECT = Effect(...)", lambda made: isinstance(made, Effect)
    ),
    "quantities": Catalogue(
        "pyrofit.quantities",
        "QUANTITY",
        "QUANTITY = Quantity(...)",
        lambda made: isinstance(made, Quantity),
    ),
    "costs": Catalogue("pyrofit.cost.added", "cost", "def cost(target, *, option): ...", _is_cost),
}
"""By subfolder."""


def use_plugins(folders: Sequence[Path]) -> None:
    """Register the definitions of some folders beside the package's own, and no others.

    Parameters
    ----------
    folders
        Folders with the subfolders ``effects``, ``quantities`` and ``costs``, at least one of them.

    Raises
    ------
    ValueError
        A folder is missing or has none of the subfolders, a name exists already, or a file cannot
        be imported or lacks its definition. Nothing of the folders is known then.
    """
    try:
        for folder in folders:
            _check_folder(folder)
        for subfolder in CATALOGUES:
            _check_names(subfolder, folders)
        _set_folders(folders)
        for subfolder in CATALOGUES:
            for path in _files(subfolder, folders):
                _check_content(subfolder, path)
    except ValueError:
        _set_folders([])
        raise


def folder_names(folders: Sequence[Path]) -> list[str]:
    """Return a name for each plugin folder, no two alike.

    >>> folder_names([Path("mine/own"), Path("yours/own")])
    ['0_own', '1_own']
    """
    return [f"{number}_{folder.resolve().name}" for number, folder in enumerate(folders)]


def plugin_files(folders: Sequence[Path]) -> dict[str, Path]:
    """Return all Python files of plugin folders, by name of the folder and place inside."""
    return {
        f"{name}/{path.relative_to(folder).as_posix()}": path
        for name, folder in zip(folder_names(folders), folders, strict=True)
        for subfolder in CATALOGUES
        for path in sorted((folder / subfolder).rglob("*.py"))
    }


def code_digest(subfolder: str, name: str) -> str:
    """Return a hash of the code that defines something: in pyrofit, a plugin, or another package.

    Comments and docstrings do not count, the helpers beside the file of a plugin and all files of
    another package do. It is empty for a cost of pyrofit.
    """
    package = _package(subfolder)
    for folder in package.__path__:
        path = Path(folder) / f"{name}.py"
        if path.is_file():
            return _digest([path, *sorted(path.parent.glob(f"{HELPER}[!_]*.py"))])
    point = added(subfolder).get(name)
    return _digest(_files_of(point.module.partition(".")[0])) if point else ""


def _digest(files: Sequence[Path]) -> str:
    codes = "".join(source_of(path).digest for path in files)
    return hashlib.sha256(codes.encode()).hexdigest()[:16]


def _files_of(package: str) -> list[Path]:
    """Return the Python files of an installed package, or of a module alone."""
    found = importlib.import_module(package)
    folders = [Path(folder) for folder in getattr(found, "__path__", ())]
    files = [path for folder in folders for path in folder.rglob("*.py")]
    return sorted(files) if folders else [Path(str(found.__file__))]


def _package(subfolder: str) -> ModuleType:
    return importlib.import_module(CATALOGUES[subfolder].package)


def _set_folders(folders: Sequence[Path]) -> None:
    for subfolder in CATALOGUES:
        package = _package(subfolder)
        own, *before = package.__path__
        after = [str((f / subfolder).resolve()) for f in folders if (f / subfolder).is_dir()]
        if before == after:
            continue
        for module in pkgutil.iter_modules(before):
            sys.modules.pop(f"{package.__name__}.{module.name}", None)
        package.__path__[:] = [own, *after]
        importlib.invalidate_caches()


def _check_folder(folder: Path) -> None:
    if not folder.is_dir():
        raise ValueError(
            f"plugins: {folder}: there is no such folder; correct the path, which is relative to "
            "the study file"
        )
    if not any((folder / subfolder).is_dir() for subfolder in CATALOGUES):
        raise ValueError(
            f"plugins: {folder}: it has no folder {' or '.join(CATALOGUES)}; put the files of your "
            "own effects, quantities and costs there"
        )


def _files(subfolder: str, folders: Sequence[Path]) -> Iterator[Path]:
    for folder in folders:
        for path in sorted((folder / subfolder).glob("*.py")):
            if not path.name.startswith(HELPER):
                yield path


def _check_names(subfolder: str, folders: Sequence[Path]) -> None:
    own = list(_package(subfolder).__path__)[:1]
    known = {name: point.module for name, point in added(subfolder).items()}
    known |= {module.name: "pyrofit" for module in pkgutil.iter_modules(own)}
    if subfolder == "costs":
        known |= dict.fromkeys(KINDS, "pyrofit")
    for path in _files(subfolder, folders):
        if not path.stem.isidentifier():
            raise ValueError(
                f"plugins: {path}: '{path.stem}' is no name; rename the file: letters, digits and "
                "_ make a name, a letter first"
            )
        if path.stem in known:
            raise ValueError(
                f"plugins: {path}: {known[path.stem]} has '{path.stem}' already; rename the file"
            )
        known[path.stem] = str(path)


def _check_content(subfolder: str, path: Path) -> None:
    catalogue = CATALOGUES[subfolder]
    try:
        content = _imported(f"{catalogue.package}.{path.stem}")
    except SyntaxError as error:
        raise ValueError(
            f"plugins: {error.filename}, line {error.lineno}: {error.msg}; correct it"
        ) from None
    except Exception as error:
        raise ValueError(
            f"plugins: {path}: cannot be imported, {type(error).__name__}: {error}; correct it"
        ) from error
    if not hasattr(content, catalogue.attribute):
        raise ValueError(
            f"plugins: {path}: it does not define `{catalogue.attribute}`; write "
            f"{catalogue.form}, or begin its name with {HELPER} if others import it"
        )
    if not catalogue.fits(getattr(content, catalogue.attribute)):
        raise ValueError(
            f"plugins: {path}: `{catalogue.attribute}` is of another kind; write {catalogue.form}"
        )


def _imported(name: str) -> ModuleType:
    """Import a file of a plugin, and leave no compiled copy beside it.

    Python takes such a copy for the file if both are of the same second and size.
    """
    before, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        return importlib.import_module(name)
    finally:
        sys.dont_write_bytecode = before
