"""Read a parameter set of any dialect into the strict form."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationError

from pyrofit.errors import DataError
from pyrofit_exchange.macfp.curves import property_curves
from pyrofit_exchange.macfp.forms import NOTHING, Nothing, PerReaction, Single, single
from pyrofit_exchange.macfp.network import Network, network_of
from pyrofit_exchange.macfp.schema import StrictSet
from pyrofit_exchange.macfp.tolerant import read_tolerant_json

_READ = {
    "Material",
    "Lab",
    "Calibration",
    "Composition",
    "Kinetics",
    "PyrolysisKinetics",
    "Thermodynamics",
    "Combustion",
    "Transport",
}
_KILO_BELOW = 1e4
"""Heats of reaction below this, beside a heat capacity in kJ/(kg K), are in kJ/kg."""


class ReadSet(NamedTuple):
    """A parameter set that was read.

    Parameters
    ----------
    path
        The file.
    strict
        The set in the strict form.
    mended
        The mended faults of the file's JSON.
    notes
        The parts read with an assumption that the file does not state, or that cannot be expressed.
    is_strict
        Whether the file is in the strict form already.
    """

    path: Path
    strict: StrictSet
    mended: tuple[str, ...]
    notes: tuple[str, ...]
    is_strict: bool


def read_set(path: Path) -> ReadSet:
    """Read a parameter set.

    Raises
    ------
    DataError
        The file is no JSON even after mending, or a part is missing or has an unknown form.
    """
    raw, mended = read_tolerant_json(path)
    try:
        return ReadSet(path, StrictSet.model_validate(raw), mended, (), not mended)
    except ValidationError:
        pass
    notes: list[str] = []
    try:
        strict = StrictSet.model_validate(_strict(str(path), raw, notes))
    except ValidationError as error:
        first = error.errors()[0]
        place = ", ".join(str(x) for x in first["loc"])
        raise DataError(f"{path}: {place}: {first['msg']}.") from None
    except DataError as error:
        words = str(error)
        raise DataError(words if words.startswith(str(path)) else f"{path}: {words}") from None
    return ReadSet(path, strict, mended, tuple(notes), False)


def _strict(where: str, raw: Mapping[str, Any], notes: list[str]) -> dict[str, Any]:
    network = network_of(where, raw, notes)
    transport = raw.get("Transport")
    thermal = raw.get("Thermodynamics")
    made: dict[str, Any] = {
        "Material": str(raw.get("Material", "")),
        "Lab": str(raw.get("Lab", "")),
        "Calibration": _calibration(raw.get("Calibration"), notes),
        "Composition": {
            "Number of Components": len(network.names),
            "Component Names": network.names,
            "Initial Mass Fraction": network.fractions,
        },
        "Kinetics": {
            "Reactants": [[i] for i in network.reactants],
            "Products": [[i] for i in network.products],
            "Pre-exponential": network.A,
            "Activation Energy": network.E,
            "Reaction Order": network.order,
            "Solid Yield": network.yields,
        },
    }
    if isinstance(thermal, Mapping):
        made["Thermodynamics"] = _thermodynamics(thermal, network, notes)
    if isinstance(transport, Mapping):
        made["Transport"] = _transport(transport, network, notes)
    combustion = raw.get("Combustion")
    if isinstance(combustion, Mapping):
        try:
            heat = _per_reaction(combustion.get("Heat of Combustion"), network, notes)
        except DataError as error:
            notes.append(f"Heat of Combustion is left out: {error}")
        else:
            made["Combustion"] = {"Heat of Combustion": heat}
    notes.extend(f"'{key}' is left out" for key in raw if key not in _READ)
    return made


def _thermodynamics(given: Mapping[str, Any], network: Network, notes: list[str]) -> dict[str, Any]:
    capacity = property_curves(given.get("Heat Capacity"), network, "Heat Capacity", notes)
    heat = _per_reaction(given.get("Heat of Pyrolysis"), network, notes)
    kilo = any("Heat Capacity" in note and "kJ" in note for note in notes)
    if kilo and not isinstance(heat, Nothing):
        values = heat.value if isinstance(heat, PerReaction) else (getattr(heat, "value", 0.0),)
        if max(abs(x) for x in values) < _KILO_BELOW:
            notes.append("Heat of Pyrolysis is taken in kJ/kg")
            heat = PerReaction(form="Reaction Specific", value=tuple(1e3 * x for x in values))
    return {
        "Heat Capacity": capacity,
        "Heat of Pyrolysis": heat,
        "Density": property_curves(given.get("Density"), network, "Density", notes),
    }


def _transport(given: Mapping[str, Any], network: Network, notes: list[str]) -> dict[str, Any]:
    absorption = given.get("Absorption", given.get("Absorption Coefficient"))
    for key, entry in given.items():
        known = ("Conductivity", "Emissivity", "Absorption", "Absorption Coefficient")
        empty = isinstance(entry, Mapping) and entry.get("Form") == "None"
        if key not in known and not empty:
            notes.append(f"not expressible: '{key}' is left out")
    return {
        "Conductivity": property_curves(given.get("Conductivity"), network, "Conductivity", notes),
        "Absorption": property_curves(absorption, network, "Absorption", notes),
        "Emissivity": property_curves(given.get("Emissivity"), network, "Emissivity", notes),
    }


def _per_reaction(given: Any, network: Network, notes: list[str]) -> Single | PerReaction | Nothing:
    """Return a number for each reaction; one for all, or one per component, is turned into that."""
    if not isinstance(given, Mapping):
        return NOTHING
    value = given.get("Value")
    values = value if isinstance(value, list) else [value]
    numbers = [float(x) if isinstance(x, int | float) else 0.0 for x in values]
    count = len(network.reactants)
    if len(numbers) == 1:
        return single(numbers[0])
    if "component" in str(given.get("Form", "")).casefold():
        numbers = [numbers[i - 1] for i in network.reactants]
    if len(numbers) != count:
        raise DataError(f"{len(numbers)} heats are given for {count} reactions; give one for each.")
    if any(x is None for x in values[:count]):
        notes.append("a heat that is not given is taken as 0")
    return PerReaction(form="Reaction Specific", value=tuple(numbers))


def _calibration(given: Any, notes: list[str]) -> list[dict[str, Any]]:
    """Return the list of calibrations; parts of another form go into their data."""
    made = []
    for one in given if isinstance(given, list) else [given] if given else []:
        if not isinstance(one, Mapping):
            notes.append(f"Calibration: '{one}' is left out")
            continue
        scope = one.get("Scope", [])
        data = one.get("Data", {})
        entry: dict[str, Any] = {
            "Method": str(one.get("Method", "")),
            "Scope": [str(x) for x in (scope if isinstance(scope, list) else [scope])],
            "Data": dict(data) if isinstance(data, Mapping) else {"Sources": data},
        }
        if "Model" in one:
            entry["Model"] = str(one["Model"])
        rest = {k: v for k, v in one.items() if k not in ("Model", "Method", "Scope", "Data")}
        entry["Data"] |= rest
        made.append(entry)
    return made
