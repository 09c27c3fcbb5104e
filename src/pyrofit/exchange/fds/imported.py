"""MATL, RAMP and SURF lines of FDS as the material of a study."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from pydantic import ValidationError

from pyrofit.constants import GAS_CONSTANT
from pyrofit.exchange.fds.arrays import array
from pyrofit.exchange.fds.depth import TWO_FLUX
from pyrofit.exchange.fds.materials import R_FDS, REFERENCE_RATE_1_S
from pyrofit.exchange.fds.namelists import unique
from pyrofit.exchange.fds.parse import read_namelists
from pyrofit.exchange.fds.properties import CELSIUS_K
from pyrofit.exchange.fds.versions import FdsError
from pyrofit.model.material import Material

Keys = dict[str, Any]
DEFAULT_EMISSIVITY, OPAQUE_1_M = 0.9, 5e4
"""What FDS takes where a MATL line is silent."""
KNOWN = {
    *("ID", "FYI", "DENSITY", "CONDUCTIVITY", "CONDUCTIVITY_RAMP", "SPECIFIC_HEAT"),
    *("SPECIFIC_HEAT_RAMP", "EMISSIVITY", "ABSORPTION_COEFFICIENT", "N_REACTIONS", "A", "E"),
    *("N_S", "MATL_ID", "NU_MATL", "SPEC_ID", "NU_SPEC", "HEAT_OF_REACTION"),
    *("HEAT_OF_COMBUSTION", "ADJUST_H"),
}
"""Keys of a MATL line that are read."""
DERIVED = {"REFERENCE_TEMPERATURE", "REFERENCE_RATE", "PYROLYSIS_RANGE", "HEATING_RATE"}
"""Keys from which FDS would make A and E, of the peak of a TGA."""


class Imported(NamedTuple):
    """A material of FDS.

    Parameters
    ----------
    material
        Keys of a study's ``material``.
    remarks
        What is not taken over, one line each.
    """

    material: Keys
    remarks: tuple[str, ...]


class _Matl(NamedTuple):
    name: str
    keys: Mapping[str, list[Any]]
    place: str

    def one(self, key: str) -> Any:
        """Return a single value, none where the line is silent."""
        given = self.keys.get(key)
        return given[0] if given else None

    def of(self, key: str, rank: int) -> dict[tuple[int, ...], Any]:
        """Return the values of an array by place, names or numbers."""
        found = array(self.keys, key, rank, self.place)
        kind = str if key.endswith("_ID") else float
        for value in found.values():
            if not isinstance(value, kind):
                what = "name" if kind is str else "number"
                raise FdsError(f"{self.place}: {key}: '{value}' is no {what}; correct it")
        return found


class _Layer(NamedTuple):
    shares: dict[str, float]
    density: float


def import_fds(text: str, source: str, old_order: bool, surface: str = "") -> Imported:
    """Return the material of a file of FDS.

    Parameters
    ----------
    text, source
        Content and name of the file.
    old_order
        Whether A of an order other than 1 has the meaning of versions up to 6.7.7.
    surface
        The SURF line whose front layer is the virgin material; the first one with a MATL_ID if
        empty.

    Raises
    ------
    FdsError
        The file has no such lines, or what they say is no material.
    """
    matls, ramps, surfs = _sorted(text, source)
    shares = _composition(surfs, matls, source, surface)
    wanted = _reached(matls, shares)
    names = unique(wanted, 60)
    density = 1.0 / sum(w / _number(matls[n], "DENSITY") for n, w in shares.items())
    layer = _Layer(shares, density)
    remarks: list[str] = [
        f"MATL '{n}': not of the virgin material, nor formed; left out"
        for n in matls
        if n not in wanted
    ]
    components: Keys = {}
    reactions: Keys = {}
    for name in wanted:
        components[names[name]] = dict(_component(matls[name], ramps))
        reactions |= dict(_reactions(matls[name], names, layer, old_order, remarks))
        remarks += _ignored(matls[name])
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
) -> tuple[dict[str, _Matl], dict[str, list[tuple[float, float]]], list[_Matl]]:
    """Return MATL lines and points of ramps by identifier, and SURF lines."""
    matls: dict[str, _Matl] = {}
    ramps: dict[str, list[tuple[float, float]]] = {}
    surfs = []
    for group, keys, line in read_namelists(text, source):
        place = f"{source}, line {line}"
        one = _Matl(str(keys.get("ID", [""])[0]), keys, place)
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
    surfs: list[_Matl], matls: Mapping[str, _Matl], source: str, wanted: str
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


def _reached(matls: Mapping[str, _Matl], shares: Mapping[str, float]) -> list[str]:
    found = list(shares)
    for name in found:  # grows as it is read
        for product in matls[name].of("MATL_ID", 2).values():
            if product not in matls:
                raise FdsError(f"{matls[name].place}: the MATL line '{product}' is missing; add it")
            if product not in found:
                found.append(product)
    return found


def _number(matl: _Matl, key: str) -> float:
    value = matl.one(key)
    if not isinstance(value, float):
        raise FdsError(f"{matl.place}: MATL '{matl.name}' has no {key}; add it")
    return value


def _component(
    matl: _Matl, ramps: Mapping[str, list[tuple[float, float]]]
) -> Iterator[tuple[str, Any]]:
    """Yield the keys of a component, SI units."""
    yield "density_kg_m3", _number(matl, "DENSITY")
    for key, own, factor in (
        ("CONDUCTIVITY", "conductivity_W_mK", 1.0),
        ("SPECIFIC_HEAT", "specific_heat_J_kgK", 1e3),
    ):
        ramp = matl.one(f"{key}_RAMP")
        if ramp is None:
            yield own, _digits(factor * _number(matl, key))
            continue
        points = sorted(ramps.get(ramp, []))
        if len(points) < 2:
            raise FdsError(f"{matl.place}: the RAMP '{ramp}' has {len(points)} lines; it needs 2")
        table = {
            "temperature_K": [round(T + CELSIUS_K, 6) for T, _ in points],
            "value": [_digits(factor * F) for _, F in points],
        }
        yield own, table
    emissivity = matl.one("EMISSIVITY")
    yield "emissivity", DEFAULT_EMISSIVITY if emissivity is None else emissivity
    kappa = matl.one("ABSORPTION_COEFFICIENT")
    if kappa is not None and kappa < OPAQUE_1_M:
        yield "absorption_1_m", _digits(kappa / TWO_FLUX)


def _digits(value: float) -> float:
    """Return a number without the noise of a change of units."""
    return float(f"{value:.12g}")


def _reactions(
    matl: _Matl, names: Mapping[str, str], layer: _Layer, old_order: bool, remarks: list[str]
) -> Iterator[tuple[str, Keys]]:
    """Yield the reactions of a component by name."""
    count = int(matl.one("N_REACTIONS") or 0)
    factors, energies, orders = (matl.of(key, 1) for key in ("A", "E", "N_S"))
    heats = matl.of("HEAT_OF_REACTION", 1)
    products, yields = matl.of("MATL_ID", 2), matl.of("NU_MATL", 2)
    gases, burnt = matl.of("NU_SPEC", 2), matl.of("HEAT_OF_COMBUSTION", 2)
    for j in range(1, count + 1):
        if (j,) not in factors or (j,) not in energies:
            given = sorted(DERIVED & {key.partition("(")[0] for key in matl.keys})
            why = f", not {', '.join(given)}, which FDS turns into them" if given else ""
            raise FdsError(f"{matl.place}: MATL '{matl.name}' needs A({j}) and E({j}){why}")
        order = float(orders.get((j,), 1.0))
        solid = {names[p]: yields.get((i, j), 0.0) for (i, k), p in products.items() if k == j}
        total = sum(solid.values()) + sum(nu for (_, k), nu in gases.items() if k == j)
        if abs(total - 1.0) > 1e-6:
            remarks.append(
                f"MATL '{matl.name}': yields of reaction {j} add up to {total:g}; "
                "the rest is taken as gas"
            )
        reaction: Keys = {"reactant": names[matl.name]}
        if present := {product: nu for product, nu in solid.items() if nu > 0.0}:
            reaction["products"] = present
        reaction["A_1_s"] = _factor(factors[j,], order, matl, layer, old_order, remarks)
        reaction["E_J_mol"] = energies[j,]
        if order != 1.0:
            reaction["order"] = order
        reaction["heat_of_reaction_J_kg"] = _digits(1e3 * heats.get((j,), 0.0))
        if (1, j) in burnt:
            reaction["heat_of_combustion_J_kg"] = _digits(1e3 * burnt[1, j])
        name = names[matl.name]
        yield (name if count == 1 else f"{name}_{j}"), reaction


def _factor(
    A: float, order: float, matl: _Matl, layer: _Layer, old_order: bool, remarks: list[str]
) -> float:
    """Return A of pyrofit [1/s], of r = A exp(-E/(R T)) m0 (m/m0)^n.

    Up to 6.7.7 r = rho_s0 A (rho_i/rho_s0)^n, from 6.7.8 on A rho_i^n, with rho_s0 of the layer.
    """
    if order != 1.0:
        share = layer.shares.get(matl.name)
        if share is None:
            remarks.append(f"MATL '{matl.name}': order {order:g} of a product; A taken as it is")
        else:
            A *= (share if old_order else share * layer.density) ** (order - 1.0)
            remarks.append(
                f"MATL '{matl.name}': order {order:g}: FDS applies it to the density of a cell, "
                "which shrinks; pyrofit to the mass"
            )
    if A > REFERENCE_RATE_1_S:
        ratio = R_FDS / GAS_CONSTANT
        A = REFERENCE_RATE_1_S * math.exp(math.log(A / REFERENCE_RATE_1_S) * ratio)
    return float(A)


def _ignored(matl: _Matl) -> Iterator[str]:
    """Yield the keys of a line that are not read."""
    for key in matl.keys:
        if key.partition("(")[0] not in KNOWN | DERIVED:
            yield f"MATL '{matl.name}': {key} is not known to pyrofit; left out"
    if matl.one("N_REACTIONS") and matl.one("ADJUST_H") is not False:
        yield (
            f"MATL '{matl.name}': FDS 6.8 and newer adjust its heat of reaction to the enthalpies "
            "(ADJUST_H); pyrofit does not"
        )


def _all_or_none(components: Mapping[str, Keys], remarks: list[str]) -> None:
    """Take away absorption coefficients that not all components have."""
    having = [name for name, of in components.items() if "absorption_1_m" in of]
    if having and len(having) < len(components):
        for name in having:
            del components[name]["absorption_1_m"]
        remarks.append("ABSORPTION_COEFFICIENT: not of every component; taken as opaque")
