"""A MATL line of FDS as a component and its reactions."""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from pyrofit.config.check.cold import reacts_cold
from pyrofit.constants import GAS_CONSTANT
from pyrofit.quantities.units import ICE_POINT_K
from pyrofit_exchange.fds.arrays import array
from pyrofit_exchange.fds.depth import TWO_FLUX
from pyrofit_exchange.fds.materials import R_FDS, REFERENCE_RATE_1_S
from pyrofit_exchange.fds.peak import HEATING_RATE_K_MIN, PYROLYSIS_RANGE_K, Peak, fds_kinetics
from pyrofit_exchange.fds.versions import FdsError, Version

Keys = dict[str, Any]
DEFAULT_EMISSIVITY, OPAQUE_1_M = 0.9, 5e4
"""FDS's defaults, where a MATL line is silent."""
SURFACE_OXIDATION = "SURFACE_OXIDATION_MODEL"
GAS_DIFFUSION_DEPTH_M = 1e-3
"""The same for the depth of oxygen."""
DERIVED = {"REFERENCE_TEMPERATURE", "REFERENCE_RATE", "PYROLYSIS_RANGE", "HEATING_RATE"}
"""Keys from which FDS makes A and E, of the peak of a TGA."""


class Matl(NamedTuple):
    """A line: its identifier, its keys, and where it stands."""

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


class VirginLayer(NamedTuple):
    """The virgin material: mass fractions by identifier, and density [kg/m3]."""

    shares: dict[str, float]
    density: float


def required_number(matl: Matl, key: str) -> float:
    """Return a number that a line must have."""
    value = matl.one(key)
    if not isinstance(value, float):
        raise FdsError(f"{matl.place}: MATL '{matl.name}' has no {key}; add it")
    return value


def component(
    matl: Matl, ramps: Mapping[str, list[tuple[float, float]]]
) -> Iterator[tuple[str, Any]]:
    """Yield the keys of a component, SI units."""
    yield "density_kg_m3", required_number(matl, "DENSITY")
    for key, own, factor in (
        ("CONDUCTIVITY", "conductivity_W_mK", 1.0),
        ("SPECIFIC_HEAT", "specific_heat_J_kgK", 1e3),
    ):
        ramp = matl.one(f"{key}_RAMP")
        if ramp is None:
            yield own, _digits(factor * required_number(matl, key))
            continue
        points = sorted(ramps.get(ramp, []))
        if len(points) < 2:
            raise FdsError(f"{matl.place}: the RAMP '{ramp}' has {len(points)} lines; it needs 2")
        table = {
            "temperature_K": [round(T + ICE_POINT_K, 6) for T, _ in points],
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


def reactions_of(
    matl: Matl, names: Mapping[str, str], layer: VirginLayer, version: Version, remarks: list[str]
) -> Iterator[tuple[str, Keys]]:
    """Yield the reactions of a component by name."""
    if matl.one(SURFACE_OXIDATION):
        remarks.append(
            f"MATL '{matl.name}': the oxidation of vegetation ({SURFACE_OXIDATION}) has A in m/s "
            "and a factor of the wind; left out. Describe it by a reaction with an oxygen_order"
        )
        return
    count = reactions_of_line(matl)
    orders = matl.of("N_S", 1)
    oxygen_orders, depths = matl.of("N_O2", 1), matl.of("GAS_DIFFUSION_DEPTH", 1)
    heats = matl.of("HEAT_OF_REACTION", 1)
    products, yields = matl.of("MATL_ID", 2), matl.of("NU_MATL", 2)
    gases, burnt = matl.of("NU_SPEC", 2), matl.of("HEAT_OF_COMBUSTION", 2)
    for j in range(1, count + 1):
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
        A, E = _kinetics(matl, j, sum(solid.values()), version, remarks)
        reaction["A_1_s"] = _factor(A, order, matl, layer, version.layer_order, remarks)
        reaction["E_J_mol"] = E
        if order != 1.0:
            reaction["order"] = order
        if oxygen_order := float(oxygen_orders.get((j,), 0.0)):
            reaction["oxygen_order"] = oxygen_order
            reaction["oxygen_depth_m"] = float(depths.get((j,), GAS_DIFFUSION_DEPTH_M))
        reaction["heat_of_reaction_J_kg"] = _digits(1e3 * heats.get((j,), 0.0))
        if (1, j) in burnt:
            reaction["heat_of_combustion_J_kg"] = _digits(1e3 * burnt[1, j])
        name = names[matl.name]
        if cold := reacts_cold(reaction["A_1_s"], E, order):
            remarks.append(f"MATL '{matl.name}', reaction {j}: {cold}")
        yield (name if count == 1 else f"{name}_{j}"), reaction


def reactions_of_line(matl: Matl) -> int:
    """Return the number of reactions; FDS takes one where a line has kinetics and no number."""
    given = matl.one("N_REACTIONS")
    if given is not None:
        return int(given)
    return int(any(matl.of(key, 1) for key in ("A", "E", "REFERENCE_TEMPERATURE")))


def _kinetics(
    matl: Matl, j: int, residue: float, version: Version, remarks: list[str]
) -> tuple[float, float]:
    """Return A [1/s] and E [J/mol] as FDS takes them: those of a peak of TGA replace given ones."""
    given = {key: matl.of(key, 1).get((j,)) for key in ("A", "E", *sorted(DERIVED))}
    A, E, temperature = given["A"], given["E"], given["REFERENCE_TEMPERATURE"]
    if temperature is None:
        if A is None or E is None:
            raise FdsError(
                f"{matl.place}: MATL '{matl.name}' needs A({j}) and E({j}), or "
                f"REFERENCE_TEMPERATURE({j}); give them"
            )
        return A, E
    peak = Peak(
        temperature,
        given["REFERENCE_RATE"],
        given["PYROLYSIS_RANGE"] or PYROLYSIS_RANGE_K,
        given["HEATING_RATE"] or HEATING_RATE_K_MIN,
        residue,
    )
    try:
        (_, old), (_, new) = (fds_kinetics(peak, of_gas) for of_gas in (True, False))
        A, E = fds_kinetics(peak, version.range_of_gas)
    except FdsError as error:
        raise FdsError(f"{matl.place}: MATL '{matl.name}', reaction {j}: {error}") from None
    said = f"MATL '{matl.name}': A and E of reaction {j} follow from REFERENCE_TEMPERATURE"
    if old != new:
        said += (
            f" as in FDS {version.name}. E is {new / 1e3:.1f} kJ/mol from 6.8 on and "
            f"{old / 1e3:.1f} in 6.7. There the rate of PYROLYSIS_RANGE is times the yield of gas, "
            "as in the User Guide until 2026. Choose by --fds-version"
        )
    remarks.append(said)
    return A, E


def _factor(
    A: float, order: float, matl: Matl, layer: VirginLayer, old_order: bool, remarks: list[str]
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
