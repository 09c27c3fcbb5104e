"""Catalogues: packages of files that each define one thing, found without being listed."""

import importlib
import pkgutil
from collections.abc import Iterable
from typing import Any


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
