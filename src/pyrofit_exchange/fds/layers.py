"""The layers of a slab: sample, adhesive, boards, contact, foil."""

from typing import NamedTuple

import numpy as np

from pyrofit.model.base import value_of
from pyrofit.model.material import Material
from pyrofit.model.slab import Adhesive, Backing, Foil, Sample
from pyrofit.solver.lower import fractions
from pyrofit.solver.lower_experiment import thicknesses
from pyrofit_exchange.fds.materials import OPAQUE_1_M, MaterialLines, Values
from pyrofit_exchange.fds.namelists import Item, Namelist

FOIL, CONTACT = "FOIL", "CONTACT"
COPPER_W_MK = 387.0
"""Conductivity of the foil, which pyrofit takes as one temperature."""
CONTACT_M = 1e-4
"""Thickness of the layer that stands for a contact resistance."""


class FdsLayer(NamedTuple):
    """A layer: shares of mass by component or by identifier of a body, and its thickness [m]."""

    shares: dict[str, float]
    thickness_m: float


def own_layers(sample: Sample, material: Material, values: Values) -> list[FdsLayer]:
    """Return sample, adhesive and boards, front first; none that has no thickness."""
    names = list(material.components)
    found = []
    for layer, size in zip(sample.layers, thicknesses(sample, values), strict=True):
        share = fractions(layer.composed(material.composition), names, values)[:, 0]
        of = {n: float(w) for n, w in zip(names, share, strict=True) if w > 0.0}
        found.append(FdsLayer(of, float(np.asarray(size))))
    behind: list[Adhesive | Backing] = [] if sample.adhesive is None else [sample.adhesive]
    bodies = [(part.component, part.thickness_m) for part in [*behind, *sample.backing]]
    found += [FdsLayer({component: 1.0}, value_of(size, values)) for component, size in bodies]
    return [layer for layer in found if layer.thickness_m > 0.0]


def foil_layers(
    foil: Foil | None, values: Values, emissivity: float, translucent: bool
) -> tuple[list[FdsLayer], list[Namelist]]:
    """Return contact resistance and foil as layers, and their MATL lines."""
    if foil is None:
        return [], []
    opaque: dict[str, Item] = {"ABSORPTION_COEFFICIENT": OPAQUE_1_M} if translucent else {}
    layers, lines = [], []
    resistance = value_of(foil.contact_m2K_W, values)
    if resistance > 0.0:
        layers.append(FdsLayer({CONTACT: 1.0}, CONTACT_M))
        no_heat: dict[str, Item] = {"DENSITY": 1.0, "SPECIFIC_HEAT": 1.0, "EMISSIVITY": 1.0}
        k = CONTACT_M / resistance
        lines.append(Namelist("MATL", {"ID": CONTACT, "CONDUCTIVITY": k, **no_heat, **opaque}))
    mass = value_of(foil.mass_factor, values)
    if mass > 0.0:
        layers.append(FdsLayer({FOIL: 1.0}, value_of(foil.thickness_m, values)))
        items: dict[str, Item] = {
            "ID": FOIL,
            "DENSITY": mass * value_of(foil.density_kg_m3, values),
            "CONDUCTIVITY": COPPER_W_MK,
            "SPECIFIC_HEAT": 1e-3 * value_of(foil.specific_heat_J_kgK, values),
            "EMISSIVITY": emissivity or 0.9,
        }
        lines.append(Namelist("MATL", items | opaque))
    return layers, lines


def layer_keys(layers: list[FdsLayer], lines: MaterialLines) -> dict[str, Item | list[Item]]:
    """Return the keys of a SURF line that name the components of its layers and their sizes."""
    items: dict[str, Item | list[Item]] = {}
    for n, layer in enumerate(layers, 1):
        parts = [
            (identifier, share * of)
            for name, share in layer.shares.items()
            for identifier, of in lines.parts.get(name, ((name, 1.0),))
        ]
        place = f"({n},1:{len(parts)})" if len(parts) > 1 else f"({n},1)"
        items[f"MATL_ID{place}"] = [identifier for identifier, _ in parts]
        if len(parts) > 1:
            items[f"MATL_MASS_FRACTION{place}"] = [share for _, share in parts]
    span = f"(1:{len(layers)})"
    items[f"THICKNESS{span}"] = [layer.thickness_m for layer in layers]
    items[f"STRETCH_FACTOR{span}"] = [1.0] * len(layers)
    return items
