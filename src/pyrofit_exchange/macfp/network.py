"""Components and reactions of a parameter set, in whichever of its dialects they are written."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pyrofit.errors import DataError

RESIDUE = "Residue"


@dataclass
class Network:
    """Components and reactions; components count from 1, and 0 is gas.

    Parameters
    ----------
    names, fractions
        Of each component.
    reactants, products, A, E, order, yields
        Of each reaction.
    place
        Place of each component among those of the file, from 0; None where it is added here.
    """

    names: list[str]
    fractions: list[float]
    reactants: list[int]
    products: list[int]
    A: list[float]
    E: list[float]
    order: list[float]
    yields: list[float]
    place: list[int | None]

    @property
    def reacting(self) -> list[bool]:
        """Whether each component reacts or is in the virgin material."""
        return [i in self.reactants or x > 0.0 for i, x in enumerate(self.fractions, start=1)]


def network_of(where: str, raw: Mapping[str, Any], notes: list[str]) -> Network:
    """Return the network of a parameter set.

    Raises
    ------
    DataError
        There are no kinetics, or a list has the wrong length.
    """
    kinetics = raw.get("Kinetics") or raw.get("PyrolysisKinetics")
    if not isinstance(kinetics, Mapping):
        raise DataError(f"{where}: there is no part 'Kinetics'; a parameter set needs one.")
    keys = ("Pre-exponential", "Activation Energy", "Reaction Order")
    A, E, order = (_numbers(where, kinetics, key) for key in keys)
    yields = _numbers(where, kinetics, "Solid Yield")
    if "Residue Yield" in kinetics:
        yields = _numbers(where, kinetics, "Residue Yield")
        notes.append("Residue Yield is taken as the solid yield, not Solid Yield")
    if len({len(A), len(E), len(order), len(yields)}) != 1:
        raise DataError(f"{where}: the lists of Kinetics differ in length; give one per reaction.")
    for i, nu in enumerate(yields):
        if not 0.0 <= nu <= 1.0:
            notes.append(
                f"Solid Yield {nu:g} of reaction {i + 1} is not within 0 and 1: taken as 0"
            )
            yields[i] = 0.0
    made = _explicit if "Reactants" in kinetics else _named
    network = made(raw, kinetics, A, E, order, yields, notes)
    _scale(network, notes)
    return network


def _numbers(where: str, part: Mapping[str, Any], key: str) -> list[float]:
    given: Any = part.get(key)
    numbers = given if isinstance(given, list) else [given]
    try:
        return [float(x) for x in numbers]
    except (TypeError, ValueError):
        raise DataError(f"{where}: Kinetics, '{key}': {given!r} is no list of numbers.") from None


def _named(
    raw: Mapping[str, Any],
    kinetics: Mapping[str, Any],
    A: list[float],
    E: list[float],
    order: list[float],
    yields: list[float],
    notes: list[str],
) -> Network:
    """Return a network that is given by name: Series, Parallel or None."""
    count = len(A)
    series = str(kinetics.get("Reaction Network", "")).casefold() == "series"
    given = kinetics.get("Initial Mass Fraction", 1)
    fractions = [float(x) for x in (given if isinstance(given, list) else [given])]
    names = [f"Component {i + 1}" for i in range(count)]
    place: list[int | None] = list(range(count))
    needs = yields[-1] > 0.0 if series else any(yields)
    if needs:
        names, fractions, place = [*names, RESIDUE], [*fractions, 0.0], [*place, None]
    last = count + 1 if needs else 0
    products = [i + 2 for i in range(count - 1)] + [last] if series else [last] * count
    products = [p if nu > 0.0 else 0 for p, nu in zip(products, yields, strict=True)]
    return Network(
        names, fractions, list(range(1, count + 1)), products, A, E, order, yields, place
    )


def _explicit(
    raw: Mapping[str, Any],
    kinetics: Mapping[str, Any],
    A: list[float],
    E: list[float],
    order: list[float],
    yields: list[float],
    notes: list[str],
) -> Network:
    """Return a network whose reactants and products are listed."""
    composition = raw.get("Composition", {})
    reactants = [_first(x) for x in kinetics["Reactants"]]
    products = [_first(x) for x in kinetics["Products"]]
    if 0 in reactants:
        notes.append("components count from 0; here they count from 1")
        reactants, products = [i + 1 for i in reactants], [i + 1 for i in products]
    fractions = [float(x) for x in composition.get("Initial Mass Fraction", [1.0])]
    names = list(composition.get("Component Names", []))
    count = max(
        int(composition.get("Number of Components", 0)), *reactants, *products, len(fractions)
    )
    names += [f"Component {i + 1}" for i in range(len(names), count)]
    fractions += [0.0] * (count - len(fractions))
    phases = composition.get("Component Phases", ["SOLID"] * count)
    kept = [i for i in range(count) if str(phases[i]).upper() != "GAS"]
    new = {old + 1: i + 1 for i, old in enumerate(kept)}
    network = Network(
        [str(names[i]) for i in kept],
        [fractions[i] for i in kept],
        [new[i] for i in reactants],
        [new.get(i, 0) if nu > 0.0 else 0 for i, nu in zip(products, yields, strict=True)],
        A,
        E,
        order,
        yields,
        list(kept),
    )
    _own_residue(network, notes)
    return network


def _own_residue(network: Network, notes: list[str]) -> None:
    """Give a component of its own to residues that are gas, or the reactants, by their index."""
    wrong = [
        i
        for i, (r, p, nu) in enumerate(
            zip(network.reactants, network.products, network.yields, strict=True)
        )
        if nu > 0.0 and p in (0, r)
    ]
    if not wrong:
        return
    shared = {network.products[i] for i in wrong} - {0}
    network.names.append(RESIDUE)
    network.fractions.append(0.0)
    network.place.append(None)
    for i, product in enumerate(network.products):
        if i in wrong or product in shared:
            network.products[i] = len(network.names)
    numbers = ", ".join(str(i + 1) for i in wrong)
    notes.append(f"reactions {numbers} form a residue without a component: one is added")


def _scale(network: Network, notes: list[str]) -> None:
    total = sum(network.fractions)
    if total > 0.0 and abs(total - 1.0) > 1e-9:
        if abs(total - 1.0) > 1e-4:
            notes.append(f"Initial Mass Fraction adds up to {total:.6g}: scaled to 1")
        network.fractions = [x / total for x in network.fractions]


def _first(indices: Any) -> int:
    return int(indices[0] if isinstance(indices, Sequence) else indices)
