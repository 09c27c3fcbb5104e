"""Report the faults of parameter sets, and the assumptions made in reading them."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from pyrofit.errors import DataError
from pyrofit_exchange.macfp.material import has_heat
from pyrofit_exchange.macfp.read import ReadSet, read_set
from pyrofit_exchange.macfp.schema import StrictSet

_USUAL = {
    "Heat Capacity": (300.0, 6000.0),
    "Density": (20.0, 3000.0),
    "Conductivity": (0.01, 5.0),
    "Emissivity": (0.3, 1.0),
}


def lint(paths: Sequence[Path]) -> Iterator[tuple[str, bool]]:
    """Yield the remarks on each file, and whether it is in the strict form."""
    strict = read = 0
    for path in paths:
        try:
            found = read_set(path)
        except DataError as error:
            words = str(error).removeprefix(f"{path}").strip(": ")
            yield f"{path.name}: cannot be read: {words}", False
            continue
        read += 1
        strict += found.is_strict
        for line in remarks(found):
            yield f"{path.name}: {line}", found.is_strict
    yield (
        f"{read} of {len(paths)} sets read, {strict} of them in the strict form",
        strict == len(paths),
    )


def remarks(found: ReadSet) -> Iterator[str]:
    """Yield the remarks on a set that was read."""
    for note in found.mended:
        yield f"no JSON: {note}"
    for note in found.notes:
        yield note
    yield from unusual(found.strict)
    if not has_heat(found.strict):
        yield "kinetics alone: it describes a TGA, no slab"
    if found.is_strict:
        yield "in the strict form"
    elif not found.mended and not found.notes:
        yield "in another dialect, read without a doubt"


def unusual(given: StrictSet) -> Iterator[str]:
    """Yield values that are far from those of polymers and woods."""
    thermal, transport = given.thermodynamics, given.transport
    forms: dict[str, Any] = {}
    if thermal is not None:
        forms |= {"Heat Capacity": thermal.heat_capacity, "Density": thermal.density}
    if transport is not None:
        forms |= {"Conductivity": transport.conductivity, "Emissivity": transport.emissivity}
    for key, form in forms.items():
        low, high = _USUAL[key]
        values = form.model_dump(by_alias=True).get("Value", [])
        for value in values if isinstance(values, list | tuple) else [values]:
            number = value.get("Value") if isinstance(value, dict) else value
            if isinstance(number, float) and not low <= number <= high:
                yield f"{key} {number:g} is unusual: {low:g} to {high:g}"
    heat = getattr(thermal, "heat_of_pyrolysis", None)
    heats = getattr(heat, "value", 0.0)
    if max(heats if isinstance(heats, tuple) else [heats]) < 0.0:
        yield "every Heat of Pyrolysis is below 0, exothermic in the data base: the other sign?"
    kinetics = given.kinetics
    for i, E in enumerate(kinetics.E, start=1):
        if not 2e4 <= E <= 4e5:
            yield f"Activation Energy {E:g} J/mol of reaction {i} is unusual: 2e4 to 4e5"
    for i, n in enumerate(kinetics.order, start=1):
        if n > 4.0:
            yield f"Reaction Order {n:g} of reaction {i} is unusual: up to 4"
