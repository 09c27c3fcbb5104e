"""Names, units and the leading candidate, as the diagnosis shows them."""

from collections.abc import Mapping, Sequence
from typing import Any

from pyrofit.effects import known_effects

Found = Mapping[str, Any]


BASE = "base"


HELD_OUT = "held out"


MOST = 12
"""Candidates and experiments that a table lists."""


CLAIMS = ("named", "ambiguous", "multiple")
"""Verdicts that claim an effect."""


MODELS = {BASE: "base model", "extended": "with the effects found"}


ROLES = {"calibration": "fitted", HELD_OUT: "held out"}


_SHOWN = {"kg/(m² s)": ("g/(m² s)", 1e3), "W/m²": ("kW/m²", 1e-3), "-": ("–", 1.0)}
"""Unit that is shown and what a value is multiplied by, where a unit is shown otherwise."""


def signal_name(signal: str) -> str:
    """Return a signal in words.

    >>> signal_name("mlr"), signal_name("back_temperature")
    ('mass loss rate', 'back temperature')
    """
    return signal.replace("_", " ").replace("mlr", "mass loss rate")


def effect_name(name: str) -> str:
    """Return title and name of an effect.

    >>> effect_name("k_T")
    'slope of the conductivity (k_T)'
    """
    effects = known_effects()
    title = effects[name].title if name in effects else name
    return name if title == name else f"{title} ({name})"


def model_name(effects: Sequence[str]) -> str:
    """Return the effects of a model, titles and names."""
    return " + ".join(effect_name(name) for name in effects)


def shown_unit(unit: str) -> tuple[str, float]:
    """Return the unit that is shown for one of the results, and the factor to it.

    >>> shown_unit("kg/(m2 s)"), shown_unit("K")
    (('g/(m² s)', 1000.0), ('K', 1.0))
    """
    written = unit.replace("m2", "m²")
    return _SHOWN.get(written, (written, 1.0))


def leading(found: Found) -> dict[str, Any] | None:
    """Return the candidate that the verdict rests on, if any: the best with just its effects."""
    effects = set(found["verdict"]["effects"])
    same = [c for c in found["candidates"] if effects and set(c["effects"]) == effects]
    best = sorted(same, key=lambda c: (bool(c["rejected"]), float(c["penalised"])))
    return best[0] if best else None


def remark(found: Found, candidate: Found) -> str:
    """Say why a candidate was rejected, or what it is if it was not."""
    kept = "in the verdict" if found["verdict"]["kind"] in CLAIMS else "not claimed"
    return candidate["rejected"] or kept


def ranked(found: Found) -> list[dict[str, Any]]:
    """Return the candidates, the lowest penalised chi-square first."""
    return sorted(found["candidates"], key=lambda c: float(c["penalised"]))
