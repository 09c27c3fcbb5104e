"""Physical effects that a model may lack: one file each, named as in a study.

A file defines ``EFFECT``; nothing else needs to know it.
"""

import importlib
import pkgutil
from dataclasses import replace
from functools import cache

from pyrofit.effects.base import Effect


@cache
def known_effects() -> dict[str, Effect]:
    """Return all effects by name, sorted."""
    effects = {}
    for name in sorted(module.name for module in pkgutil.iter_modules(__path__)):
        content = importlib.import_module(f"{__name__}.{name}")
        if hasattr(content, "EFFECT"):
            effects[name] = replace(content.EFFECT, name=name)
    return effects
