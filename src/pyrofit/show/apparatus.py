"""Usual errors of an apparatus, in words."""

from pyrofit.experiments.slab.uncertain import PLACES


def usual_errors() -> str:
    """Return their standard deviations.

    >>> usual_errors()[:42]
    'flux 3 %, thickness 2 %, h 2 W/(m² K), gas'
    """
    parts = []
    for place in PLACES.values():
        size = f"{100.0 * place.sd:g} %" if place.unit == "-" else f"{place.sd:g} {place.unit}"
        parts.append(f"{place.words} {size.replace('m2', 'm²')}")
    return ", ".join(parts)
