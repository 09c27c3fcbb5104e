"""Physical effects that a model may lack: one file each, named as in a study.

A file defines ``EFFECT``; nothing else needs to know it. Other packages add effects by entry points
of the group ``pyrofit.effects``.
"""

from dataclasses import replace
from functools import cache

from pyrofit.discovery import catalogue
from pyrofit.effects.base import Effect


def known_effects() -> dict[str, Effect]:
    """Return all effects by name, sorted."""
    return _effects_in(tuple(__path__))


@cache
def _effects_in(folders: tuple[str, ...]) -> dict[str, Effect]:
    found = catalogue(__name__, folders, "EFFECT", "effects", Effect)
    return {name: replace(effect, name=name) for name, effect in found.items()}


def same_as(effect: str) -> set[str]:
    """Return an effect and those that no data of these kinds can tell from it.

    >>> sorted(same_as("time_offset"))
    ['heater_ramp', 'time_offset']
    """
    partners = {n for n, e in known_effects().items() if e.same_as == effect}
    return {effect, known_effects()[effect].same_as or effect} | partners
