"""Physical effects that a model may lack: one file each, named as in a study.

A file defines ``EFFECT``; nothing else needs to know it.
"""

import importlib
import pkgutil
from dataclasses import replace
from functools import cache

from pyrofit.effects.base import Effect


def known_effects() -> dict[str, Effect]:
    """Return all effects by name, sorted."""
    return _effects_in(tuple(__path__))


@cache
def _effects_in(folders: tuple[str, ...]) -> dict[str, Effect]:
    effects = {}
    for name in sorted(module.name for module in pkgutil.iter_modules(folders)):
        content = importlib.import_module(f"{__name__}.{name}")
        if hasattr(content, "EFFECT"):
            effects[name] = replace(content.EFFECT, name=name)
    return effects


def same_as(effect: str) -> set[str]:
    """Return an effect and those that no data of these kinds can tell from it.

    >>> sorted(same_as("time_offset"))
    ['heater_ramp', 'time_offset']
    """
    partners = {n for n, e in known_effects().items() if e.same_as == effect}
    return {effect, known_effects()[effect].same_as or effect} | partners
