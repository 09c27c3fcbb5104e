"""A material with the values of a set in the place of its parameters."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from pyrofit.model.material import REST, Material
from pyrofit.model.properties import Changed
from pyrofit.solver.arrays import TABLE_TEMPERATURES_K
from pyrofit_exchange.fds.properties import needed, tabulated

_PROPERTIES = (
    "conductivity_W_mK",
    "specific_heat_J_kgK",
    "expansion",
    "absorption_factor",
)
_NAMES = ("reactant", "products")


def numeric_material(material: Material, values: Mapping[str, float]) -> tuple[Material, list[str]]:
    """Return a material without parameters, and notes on the properties turned into tables.

    A property of a form that the data base lacks becomes a table, with the points that straight
    lines need to follow it within 1e-6.
    """
    notes: list[str] = []
    given = material.model_dump(mode="python")
    for name, component in material.components.items():
        for key in _PROPERTIES:
            form = getattr(component, key)
            if isinstance(form, Changed):
                given["components"][name][key] = _table(form, values)
                notes.append(f"{key} of {name} is written as a table")
    made = {
        "components": {n: _filled(c, values) for n, c in given["components"].items()},
        "reactions": {
            n: {k: v if k == _NAMES[0] else _filled(v, values) for k, v in reaction.items()}
            for n, reaction in given["reactions"].items()
        },
        "composition": _shares(given["composition"], values),
    }
    return Material.model_validate(made), notes


def _shares(given: Mapping[str, Any], values: Mapping[str, float]) -> dict[str, float]:
    """Return the mass fractions, the rest included."""
    known = {n: float(_filled(x, values)) for n, x in given.items() if x != REST}
    return {n: known.get(n, 1.0 - sum(known.values())) for n in given}


def _filled(given: Any, values: Mapping[str, float]) -> Any:
    """Return a copy in which every name of a parameter is its value."""
    if isinstance(given, Mapping):
        return {key: _filled(x, values) for key, x in given.items()}
    if isinstance(given, list | tuple):
        return [_filled(x, values) for x in given]
    return float(values[given]) if isinstance(given, str) else given


def _table(form: Changed, values: Mapping[str, float]) -> dict[str, Any]:
    table = np.broadcast_to(tabulated(form, values), TABLE_TEMPERATURES_K.shape)
    points = needed(TABLE_TEMPERATURES_K, table)
    return {
        "temperature_K": TABLE_TEMPERATURES_K[points].tolist(),
        "value": table[points].tolist(),
    }
