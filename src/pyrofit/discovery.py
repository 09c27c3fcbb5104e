"""What is found without being listed: files of catalogues, and packages beside pyrofit.

A package beside pyrofit adds to it by entry points, in groups such as ``pyrofit.commands``, as
`docs/adding.md` says. pyrofit imports none of them by name.
"""

import importlib
import pkgutil
import tomllib
from collections.abc import Iterable
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

from pyrofit.errors import PyrofitError

_OWN = "pyrofit"
_HERE = Path(__file__).parents[1]
"""Folder of the package, in which the packages of its wheel are, too."""


def contents(package: str, folders: Iterable[str], attribute: str) -> dict[str, Any]:
    """Return the objects that the files of a catalogue define, by file name, sorted.

    Parameters
    ----------
    package
        Full name of the package.
    folders
        Its folders, ``__path__``; those of a study's plugins are among them.
    attribute
        Name that a file defines; files without it are left out.
    """
    found = {}
    for name in sorted(module.name for module in pkgutil.iter_modules(folders)):
        content = importlib.import_module(f"{package}.{name}")
        if hasattr(content, attribute):
            found[name] = getattr(content, attribute)
    return found


def rooms(package: str, folders: Iterable[str], attribute: str) -> dict[str, Any]:
    """Return the objects that the folders in another package define, as `contents` does.

    The package does not import them itself, so that each of them may stand alone.
    """
    return contents(package, folders, attribute)


def catalogue(
    package: str, folders: Iterable[str], attribute: str, group: str, kind: type
) -> dict[str, Any]:
    """Return the objects of a catalogue and those that other packages add, by name, sorted.

    Parameters
    ----------
    package, folders, attribute
        As of `contents`.
    group
        Group of entry points, as of `added`.
    kind
        Class of the objects.

    Raises
    ------
    PyrofitError
        Another package adds a name that exists, or an object of another class.
    """
    found = contents(package, folders, attribute)
    for name, point in added(group).items():
        if name in found:
            raise PyrofitError(
                f"{point.value}: '{name}' is among the {group} of pyrofit already; give it another "
                f"name in the {point.group} of its package"
            )
        found[name] = loaded(point)
        if not isinstance(found[name], kind):
            raise PyrofitError(
                f"{point.value}, which adds '{name}' to {point.group}, is no {kind.__name__}; name "
                "the object itself, or uninstall its package"
            )
    return dict(sorted(found.items()))


def added(group: str) -> dict[str, EntryPoint]:
    """Return what other packages add to pyrofit, by name, sorted; nothing is imported.

    Parameters
    ----------
    group
        Such as 'commands', as `docs/adding.md` lists them.

    Raises
    ------
    PyrofitError
        Two packages add the same name, or a package lies beside pyrofit without being installed.
    """
    return entries_beside(_HERE).get(f"{_OWN}.{group}", {})


def loaded(point: EntryPoint) -> Any:
    """Return the object of an entry point.

    Raises
    ------
    PyrofitError
        It cannot be imported.
    """
    try:
        return point.load()
    except (ImportError, AttributeError) as error:
        raise PyrofitError(
            f"{point.value}, which adds '{point.name}' to {point.group}, cannot be imported: "
            f"{error}. Install its package again, or uninstall it"
        ) from error


@cache
def entries_beside(folder: Path) -> dict[str, dict[str, EntryPoint]]:
    """Return entry points by group and name, those of a clone from its ``pyproject.toml``.

    Those that were installed with a clone are as old as the installation.
    """
    of_clone = _of_clone(folder.parent / "pyproject.toml")
    found: dict[str, dict[str, EntryPoint]] = {}
    for point in [*of_clone, *_installed()]:
        known = found.setdefault(point.group, {}).setdefault(point.name, point)
        of_old = bool(of_clone) and point.dist is not None and point.dist.name == _OWN
        if known.value != point.value and not of_old:
            raise PyrofitError(
                f"'{point.name}' of {point.group} is both {known.value} and {point.value}; "
                "uninstall one of their packages"
            )
    homes = {point.module.partition(".")[0] for group in found.values() for point in group.values()}
    for path in sorted(folder.glob(f"{_OWN}_*/__init__.py")):
        if path.parent.name not in homes:
            raise PyrofitError(
                f"{path.parent}: the installation of pyrofit does not know this package, so its "
                "commands would be missing; install pyrofit again"
            )
    return {group: dict(sorted(points.items())) for group, points in found.items()}


def _installed() -> list[EntryPoint]:
    points = entry_points()
    groups = sorted(group for group in points.groups if group.startswith(f"{_OWN}."))
    return [point for group in groups for point in points.select(group=group)]


def _of_clone(project: Path) -> list[EntryPoint]:
    if not project.is_file():
        return []
    described = tomllib.loads(project.read_text(encoding="utf-8")).get("project", {})
    if described.get("name") != _OWN:
        return []
    groups = described.get("entry-points", {}).items()
    return [EntryPoint(name, value, group) for group, of in groups for name, value in of.items()]
