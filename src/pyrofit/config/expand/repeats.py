"""Repeats of a test: each becomes an experiment of its own when a study is read."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import TypeAdapter, ValidationError

from pyrofit.config.expand.nuisances import (
    NUISANCES,
    Keys,
    free_numbers,
    scattered,
    stages_that_fit,
)
from pyrofit.config.expand.repeated_names import at_costs, at_names, at_signals
from pyrofit.config.words import in_plain_words, require
from pyrofit.experiments import KINDS
from pyrofit.model.repeats import AnyRepeats, Nuisances, Repeat, Repeats

OF_PROGRAMS = (
    "make it one of the `parameters`, with a value under `known`, and name it in the template, "
    "or in delay_s or offset of a signal"
)


def free_uncertain(keys: Keys) -> Keys:
    """Return a study's keys with uncertain conditions of its experiments as parameters.

    The diagnosis alone estimates them, where it calibrates the experiment or holds it out: only
    there do known values have weights.

    Raises
    ------
    ValueError
        As `free_numbers`; or the experiment cannot have it.
    """
    for name, experiment in keys["experiments"].items():
        if not isinstance(experiment, Mapping) or experiment.get("uncertain") is None:
            continue
        place = f"experiments.{name}.uncertain"
        sds = _uncertain(place, experiment)
        kept = {key: given for key, given in experiment.items() if key != "uncertain"}
        kept["repeat"] = {"test": name}
        keys = {**keys, "experiments": {**keys["experiments"], name: kept}}
        stages = [stage for stage in stages_that_fit(keys, name) if stage == "diagnosis"]
        keys = free_numbers(keys, name, sds, stages)
    return keys


def _uncertain(place: str, experiment: Mapping[str, Any]) -> dict[str, float]:
    try:
        sds = Nuisances.model_validate(experiment["uncertain"]).given
    except ValidationError as error:
        lines = in_plain_words(error, experiment["uncertain"])
        raise ValueError("; ".join(f"{place}.{line}" for line in lines)) from None
    for key in sds:
        check_family(f"{place}.{key}", key, experiment.get("kind"))
    return sds


def check_family(place: str, key: str, kind: Any) -> None:
    """Refuse a standard deviation that the kind of an experiment has not.

    Raises
    ------
    ValueError
        With the place, and those that it may have.
    """
    known = KINDS.get(kind) if isinstance(kind, str) else None
    if known is not None and not issubclass(known.description, NUISANCES[key].family):
        fitting = [k for k, n in NUISANCES.items() if issubclass(known.description, n.family)]
        way = f"it may have {', '.join(fitting)}" if fitting else OF_PROGRAMS
        raise ValueError(f"{place}: a {known.words} experiment has none; {way}")


_REPEATS: TypeAdapter[Repeats] = TypeAdapter(AnyRepeats)
SYNTHETIC = "synthetic"


@dataclass(frozen=True)
class _Test:
    """A repeated test: its repeats as experiments, and the standard deviations of each."""

    experiments: dict[str, Keys]
    sds: dict[str, dict[str, float]]


def expand_repeats(given: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a study's keys with each repeat as an experiment of its own.

    The name of the test stands for all repeats that have the signal: in costs they share the weight
    of the term equally. Numbers that differ between repeats become parameters with known values,
    which every stage estimates that fits the repeat.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    experiments = given.get("experiments")
    if not isinstance(experiments, Mapping):
        return given  # the checks of the study report the error
    tests = {
        name: _test(name, experiment, experiments)
        for name, experiment in experiments.items()
        if isinstance(experiment, Mapping) and experiment.get("repeats") is not None
    }
    uncertain = any(isinstance(e, Mapping) and e.get("uncertain") for e in experiments.values())
    if not tests and not uncertain:
        return given
    keys = _expanded(given, tests)
    sds = {own: given for test in tests.values() for own, given in test.sds.items()}
    try:
        for own, of in sds.items():
            keys = free_numbers(keys, own, of, stages_that_fit(keys, own))
        return scattered(free_uncertain(keys), sds)
    except (AttributeError, KeyError, TypeError):
        return keys  # as above


def _expanded(given: Mapping[str, Any], tests: Mapping[str, _Test]) -> Keys:
    """Return the keys with repeats in place of tests wherever these are named."""
    keys = dict(given)
    keys["experiments"] = {}
    for name, experiment in given["experiments"].items():
        new = tests[name].experiments if name in tests else {name: experiment}
        for own in new:
            require(
                own not in keys["experiments"] and (own == name or own not in given["experiments"]),
                f"experiments.{name}.repeats",
                f"another experiment is named '{own}'; give the repeats other names",
            )
        keys["experiments"] |= new
    repeats = {
        name: {own: set(keys["signals"]) for own, keys in test.experiments.items()}
        for name, test in tests.items()
    }
    return at_names(at_signals(at_costs(keys, repeats), repeats), repeats)


def _test(name: str, experiment: Mapping[str, Any], others: Mapping[str, Any]) -> _Test:
    place = f"experiments.{name}.repeats"
    require(
        experiment.get("uncertain") is None,
        f"experiments.{name}.uncertain",
        "the test has repeats; give it there, under `repeats`",
    )
    try:
        repeats = _REPEATS.validate_python(experiment["repeats"])
    except ValidationError as error:
        lines = in_plain_words(error, experiment["repeats"])
        raise ValueError("; ".join(f"{place}.{line}" for line in lines)) from None
    listed = repeats.tests
    if not isinstance(listed, Mapping):
        listed = {f"{name}_{i}": repeat for i, repeat in enumerate(listed, 1)}
    require(len(listed) > 1, place, "give at least two repeats, or leave the key out")
    found, sds = {}, {}
    for own, repeat in listed.items():
        found[own] = _experiment(name, own, experiment, repeat)
        sds[own] = repeats.given | repeat.given
        for key in sds[own]:
            check_family(f"{place}.{own}.{key}", key, experiment.get("kind"))
    _check_files(place, found)
    return _Test(found, sds)


def _experiment(name: str, own: str, experiment: Mapping[str, Any], repeat: Repeat) -> Keys:
    """Return the keys of one repeat: those of the test, its own files and values instead."""
    place = f"experiments.{name}.repeats.{own}"
    shared = experiment.get("signals") or {}
    given: dict[str, Keys] = {key: {} for key, keys in shared.items() if _is_synthetic(keys)} | {
        signal: {"file": keys} if isinstance(keys, str) else keys
        for signal, keys in repeat.signals.items()
    }
    require(bool(given), place, "it has no file; give under signals the file of each signal")
    of_sample = repeat.model_dump(include={"sample_mass_kg", "sample_area_m2"}, exclude_none=True)
    signals = {}
    for signal, keys in given.items():
        here = shared.get(signal)
        here = dict(here) if isinstance(here, Mapping) else {}
        signals[signal] = {**here, **of_sample, **keys}
        require(
            "file" in keys or _is_synthetic(here),
            f"{place}.signals.{signal}",
            "give the file of this repeat",
        )
    title = repeat.title or f"{experiment.get('title') or name}, {own.removeprefix(f'{name}_')}"
    kept = {key: value for key, value in experiment.items() if key != "repeats"}
    if repeat.sample:
        require(
            isinstance(experiment.get("sample"), Mapping),
            f"{place}.sample",
            "the test has no sample; leave it out, or describe the sample of the test",
        )
        kept["sample"] = {**experiment["sample"], **repeat.sample}
    return {**kept, "title": title, "signals": signals, "repeat": {"test": name}}


def _is_synthetic(keys: Any) -> bool:
    return isinstance(keys, Mapping) and keys.get("file") == SYNTHETIC


def _check_files(place: str, experiments: Mapping[str, Keys]) -> None:
    """Refuse one file for the same signal of two repeats."""
    seen: dict[tuple[str, Any], str] = {}
    for own, keys in experiments.items():
        for signal, described in keys["signals"].items():
            file = described["file"]
            require(
                file == SYNTHETIC or (signal, file) not in seen,
                f"{place}.{own}.signals.{signal}",
                f"'{file}' is the file of {seen.get((signal, file))}, too; give its own file",
            )
            seen[signal, file] = own
