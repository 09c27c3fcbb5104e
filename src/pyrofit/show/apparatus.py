"""Usual errors of an apparatus, in words."""

from pyrofit.experiments.slab.uncertain import PLACES

_NAMES = {"gas": "gas temperature", "start": "initial temperature", "back_loss": "loss of the back"}


def usual_errors() -> str:
    """Return their standard deviations.

    >>> usual_errors()[:42]
    'flux 3 %, thickness 2 %, h 2 W/(m² K), gas'
    """
    parts = []
    for key, place in PLACES.items():
        size = f"{100.0 * place.sd:g} %" if place.unit == "-" else f"{place.sd:g} {place.unit}"
        parts.append(f"{_NAMES.get(key, key)} {size.replace('m2', 'm²')}")
    return ", ".join(parts)
