"""MATL, RAMP and SURF lines of FDS as the material of a study."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from pydantic import ValidationError

from pyrofit.model.material import Material
from pyrofit_exchange.fds.matl_line import (
    DERIVED,
    SURFACE_OXIDATION,
    Keys,
    Matl,
    VirginLayer,
    component,
    reactions_of,
    reactions_of_line,
    required_number,
)
from pyrofit_exchange.fds.namelists import unique
from pyrofit_exchange.fds.parse import read_namelists
from pyrofit_exchange.fds.versions import FdsError, Version

KNOWN = {
    *("ID", "FYI", "DENSITY", "CONDUCTIVITY", "CONDUCTIVITY_RAMP", "SPECIFIC_HEAT"),
    *("SPECIFIC_HEAT_RAMP", "EMISSIVITY", "ABSORPTION_COEFFICIENT", "N_REACTIONS", "A", "E"),
    *("N_S", "MATL_ID", "NU_MATL", "SPEC_ID", "NU_SPEC", "HEAT_OF_REACTION"),
    *("HEAT_OF_COMBUSTION", "ADJUST_H", "N_O2", "GAS_DIFFUSION_DEPTH", SURFACE_OXIDATION),
}
"""Keys of a MATL line that are read."""


class Imported(NamedTuple):
    """A material of FDS.

    Parameters
    ----------
    material
        Keys of a study's ``material``.
    remarks
        The parts that are not taken over, one line each.
    """

    material: Keys
    remarks: tuple[str, ...]


def import_fds(text: str, source: str, version: Version, surface: str = "") -> Imported:
    """Return the material of a file of FDS.

    Parameters
    ----------
    text, source
        Content and name of the file.
    version
        The version for which the file was written.
    surface
        The SURF line whose front layer is the virgin material; the first one with a MATL_ID if
        empty.

    Raises
    ------
    FdsError
        The file has no such lines, or they describe no material.
    """
    matls, ramps, surfs = _sorted(text, source)
    shares = _composition(surfs, matls, source, surface)
    wanted = _reached(matls, shares)
    names = unique(wanted, 60)
    density = 1.0 / sum(w / required_number(matls[n], "DENSITY") for n, w in shares.items())
    layer = VirginLayer(shares, density)
    remarks: list[str] = [
        f"MATL '{n}': not of the virgin material, nor formed; left out"
        for n in matls
        if n not in wanted
    ]
    components: Keys = {}
    reactions: Keys = {}
    for name in wanted:
        components[names[name]] = dict(component(matls[name], ramps))
        reactions |= dict(reactions_of(matls[name], names, layer, version, remarks))
        remarks += _ignored(matls[name], version)
    _all_or_none(components, remarks)
    material = {
        "components": components,
        **({"reactions": reactions} if reactions else {}),
        "composition": {names[n]: w for n, w in shares.items()},
    }
    try:
        Material.model_validate(material)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        raise FdsError(f"{source}: no material of pyrofit: {place}: {first['msg']}") from None
    return Imported(material, tuple(dict.fromkeys(remarks)))


def _sorted(
    text: str, source: str
) -> tuple[dict[str, Matl], dict[str, list[tuple[float, float]]], list[Matl]]:
    """Return MATL lines and points of ramps by identifier, and SURF lines."""
    matls: dict[str, Matl] = {}
    ramps: dict[str, list[tuple[float, float]]] = {}
    surfs = []
    for group, keys, line in read_namelists(text, source):
        place = f"{source}, line {line}"
        one = Matl(str(keys.get("ID", [""])[0]), keys, place)
        if group == "MATL":
            matls[one.name] = one
        elif group == "SURF":
            surfs.append(one)
        elif group == "RAMP" and "T" in keys and "F" in keys:
            ramps.setdefault(one.name, []).append((float(keys["T"][0]), float(keys["F"][0])))
    if not matls:
        raise FdsError(f"{source}: it has no MATL line; give the file that has them")
    return matls, ramps, surfs


def _composition(
    surfs: list[Matl], matls: Mapping[str, Matl], source: str, wanted: str
) -> dict[str, float]:
    """Return the mass fractions of the front layer of a SURF line."""
    having = [s for s in surfs if any(k.startswith("MATL_ID") for k in s.keys)]
    chosen = [s for s in having if not wanted or s.name == wanted]
    if not chosen:
        known = ", ".join(s.name for s in having) or "none"
        which = f"SURF line '{wanted}'" if wanted else "SURF line with a MATL_ID"
        if len(matls) == 1 and not wanted:
            return dict.fromkeys(matls, 1.0)
        raise FdsError(f"{source}: there is no {which}; SURF lines with materials: {known}")
    surf = chosen[0]
    ids = {j: name for (i, j), name in surf.of("MATL_ID", 2).items() if i == 1}
    fractions = {j: w for (i, j), w in surf.of("MATL_MASS_FRACTION", 2).items() if i == 1}
    shares = {
        name: float(fractions.get(j, 1.0 if len(ids) == 1 else 0.0)) for j, name in ids.items()
    }
    for name in shares:
        if name not in matls:
            raise FdsError(f"{surf.place}: the MATL line '{name}' is missing; add it")
    if abs(sum(shares.values()) - 1.0) > 1e-6:
        raise FdsError(f"{surf.place}: MATL_MASS_FRACTION adds up to {sum(shares.values()):g}")
    present = {name: w for name, w in shares.items() if w > 0.0}
    *first, last = present
    rest = round(1.0 - sum(present[name] for name in first), 15)
    return {**{name: present[name] for name in first}, last: rest}


def _reached(matls: Mapping[str, Matl], shares: Mapping[str, float]) -> list[str]:
    found = list(shares)
    for name in found:  # grows as it is read
        for product in matls[name].of("MATL_ID", 2).values():
            if product not in matls:
                raise FdsError(f"{matls[name].place}: the MATL line '{product}' is missing; add it")
            if product not in found:
                found.append(product)
    return found


def _ignored(matl: Matl, version: Version) -> Iterator[str]:
    """Yield the keys of a line that are not read."""
    for key in matl.keys:
        if key.partition("(")[0] not in KNOWN | DERIVED:
            yield f"MATL '{matl.name}': {key} is not known to pyrofit; left out"
    if version.adjusts_heat and reactions_of_line(matl) and matl.one("ADJUST_H") is not False:
        yield (
            f"MATL '{matl.name}': FDS {version.name} adjusts its heat of reaction to the "
            "enthalpies (ADJUST_H); pyrofit does not"
        )


def _all_or_none(components: Mapping[str, Keys], remarks: list[str]) -> None:
    """Take away absorption coefficients that not all components have."""
    having = [name for name, of in components.items() if "absorption_1_m" in of]
    if having and len(having) < len(components):
        for name in having:
            del components[name]["absorption_1_m"]
        remarks.append("ABSORPTION_COEFFICIENT: not of every component; taken as opaque")
