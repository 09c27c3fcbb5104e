"""Usual errors of an apparatus, in words."""

from pyrofit.experiments.slab.uncertain import PLACES

_SHOWN = {"-": (100.0, "%"), "W/m2": (1e-3, "kW/m²"), "W/(m2 K)": (1.0, "W/(m² K)")}
"""Factors and units of standard deviations by unit."""


def usual_errors() -> str:
    """Return their standard deviations.

    >>> usual_errors()[:42]
    'flux 3 %, thickness 2 %, h 2 W/(m² K), gas'
    """
    parts = []
    for place in PLACES.values():
        factor, unit = _SHOWN.get(place.unit, (1.0, place.unit))
        parts.append(f"{place.words} {factor * place.sd:g} {unit}")
    return ", ".join(parts)
