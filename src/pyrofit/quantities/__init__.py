"""Quantities that are measured: one file each, named as in a study.

A file defines ``QUANTITY``; nothing else needs to know it. Other packages add quantities by entry
points of the group ``pyrofit.quantities``.
"""

from dataclasses import replace
from functools import cache

from pyrofit.discovery import catalogue
from pyrofit.quantities.base import Quantity


def known_quantities() -> dict[str, Quantity]:
    """Return all quantities by name, sorted.

    >>> known_quantities()["mlr"].title
    'mass loss rate'
    """
    return _quantities_in(tuple(__path__))


def quantities_of(kind: str) -> dict[str, Quantity]:
    """Return the quantities that a kind of experiment measures, by name.

    >>> list(quantities_of("tga"))
    ['mass_fraction']
    """
    return {name: q for name, q in known_quantities().items() if kind in q.kinds}


@cache
def _quantities_in(folders: tuple[str, ...]) -> dict[str, Quantity]:
    found = catalogue(__name__, folders, "QUANTITY", "quantities", Quantity)
    return {name: replace(quantity, name=name) for name, quantity in found.items()}
