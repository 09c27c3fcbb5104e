"""Quantities that are measured: one file each, named as in a study.

A file defines ``QUANTITY``; nothing else needs to know it but the kinds of experiment that
measure it.
"""

import importlib
import pkgutil
from dataclasses import replace
from functools import cache

from pyrofit.quantities.base import Quantity


def known_quantities() -> dict[str, Quantity]:
    """Return all quantities by name, sorted.

    >>> known_quantities()["mlr"].title
    'mass loss rate'
    """
    return _quantities_in(tuple(__path__))


@cache
def _quantities_in(folders: tuple[str, ...]) -> dict[str, Quantity]:
    quantities = {}
    for name in sorted(module.name for module in pkgutil.iter_modules(folders)):
        content = importlib.import_module(f"{__name__}.{name}")
        if hasattr(content, "QUANTITY"):
            quantities[name] = replace(content.QUANTITY, name=name)
    return quantities
