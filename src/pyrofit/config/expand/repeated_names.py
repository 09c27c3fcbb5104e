"""Names of repeated tests in a study: the names of all their repeats instead."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

Keys = dict[str, Any]
Repeats = Mapping[str, Mapping[str, set[str]]]
"""By test and repeat, the signals of the repeat."""


def at_costs(keys: Keys, repeats: Repeats) -> Keys:
    """Return the keys with the terms of all costs expanded; repeats share the weight equally."""
    keys = _at(keys, "kinetics.cost", lambda terms: _terms("kinetics.cost", terms, repeats))
    return _at(
        keys,
        "imp.costs",
        lambda costs: {n: _terms(f"imp.costs.{n}", terms, repeats) for n, terms in costs.items()},
    )


def at_signals(keys: Keys, repeats: Repeats) -> Keys:
    """Return the keys with signals chosen by experiment expanded."""
    for place in ("imp.identification", "diagnosis.calibrate", "diagnosis.hold_out"):
        keys = _at(keys, place, partial(_chosen, place, repeats))
    return keys


def at_names(keys: Keys, repeats: Repeats) -> Keys:
    """Return the keys with lists of experiments expanded."""
    for place in ("validation.experiments", "kinetics.compare"):
        keys = _at(
            keys, place, lambda names: [own for n in names for own in repeats.get(n, {n: set()})]
        )
    return keys


def _at(keys: Keys, place: str, change: Callable[[Any], Any]) -> Keys:
    """Return the keys with one of them changed; as they are where it is none or malformed."""
    stage, key = place.split(".")
    part = keys.get(stage)
    if not isinstance(part, Mapping) or not part.get(key):
        return keys
    try:
        return {**keys, stage: {**part, key: change(part[key])}}
    except (AttributeError, TypeError):
        return keys  # the checks of the study report the error


def _terms(place: str, terms: Any, repeats: Repeats) -> list[Any]:
    """Return terms with one for each repeat that has the signal; these share the weight."""
    found = []
    for i, term in enumerate(terms):
        test = repeats.get(term.get("experiment"))
        if test is None:
            found.append(term)
            continue
        names = _having(f"{place}.{i}.signal", term.get("experiment"), term.get("signal"), test)
        weight = term.get("weight", 1.0) / len(names)
        found += [{**term, "experiment": own, "weight": weight} for own in names]
    return found


def _chosen(place: str, repeats: Repeats, chosen: Mapping[str, Any]) -> Keys:
    """Return signals by experiment, those of a test at each repeat that has them."""
    found: Keys = {}
    for name, signals in chosen.items():
        test = repeats.get(name)
        if test is None:
            found[name] = signals
            continue
        for signal in signals:
            for own in _having(f"{place}.{name}", name, signal, test):
                found.setdefault(own, []).append(signal)
    return found


def _having(place: str, test: str, signal: Any, repeats: Mapping[str, set[str]]) -> list[str]:
    names = [own for own, signals in repeats.items() if signal in signals]
    if not names:
        known = ", ".join(sorted(set().union(*repeats.values())))
        raise ValueError(
            f"{place}: no repeat of '{test}' has the signal '{signal}'. Known: {known}."
        )
    return names
