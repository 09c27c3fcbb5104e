"""Names and numbers that a caller gives, checked: values of parameters, experiments, signals."""

import math
from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from typing import Any

import numpy as np
import pandas as pd

from pyrofit.api.arguments import word_of
from pyrofit.config import Study, parameters_in
from pyrofit.config.check.numbers import parts_with_numbers
from pyrofit.config.resolve import diagnosed_material
from pyrofit.config.uses import parameters_of_heated
from pyrofit.errors import StudyError, suggest
from pyrofit.experiments import kind_of
from pyrofit.model.base import Rule, numbers
from pyrofit.solver.arrays import FloatArray

Key = tuple[str, str]
"""Names of an experiment and a signal."""
Signals = str | Iterable[str | Key] | Mapping[str, str | Iterable[str]]
"""Experiments with all their signals, pairs of experiment and signal, or signals by experiment."""


Place = tuple[str, str, tuple[Rule, ...]]
"""Place of a number in the description, the parameter that stands there, rules of the place."""


def si_values(
    study: Study, given: Mapping[str, float], places: Iterable[Place] | None = None
) -> dict[str, float]:
    """Return values in SI units; they are given in the units of the study.

    Who checks many sets gives `places_of_parameter` the study.

    Raises
    ------
    StudyError
        A name is no parameter or that of an expression, or a value is no finite number, or breaks
        a rule of a place where it is used.
    """
    if not hasattr(given, "items"):
        raise StudyError(
            "values by name are needed, such as {'k': 0.2} or the `values` of a fit; this is "
            f"{_kind(given)}"
        )
    found: dict[str, float] = {}
    for name, value in given.items():
        check_parameter(study, name)
        expression = study.parameters[name].expression
        if expression is not None:
            raise StudyError(
                f"parameter '{name}' is the expression '{expression}'; give values of the "
                "parameters in it"
            )
        if not (isinstance(value, Real) and math.isfinite(value)):
            raise StudyError(f"parameter '{name}': {value!r} is no finite number")
        found[name] = float(value) * study.parameters[name].factor
    _check_rules(study, found, places_of_parameter(study) if places is None else places)
    return found


def si_columns(study: Study, given: pd.DataFrame) -> dict[str, FloatArray]:
    """Return the columns of a table of sets in SI units, shape (sets,) each.

    Raises
    ------
    StudyError
        As of `si_values`, or there is no set, or a name stands above two columns.
    """
    if not len(given):
        raise StudyError("values: the table has no row; give a set of parameters a row")
    names = list(given.columns)
    if twice := sorted({str(name) for name in names if names.count(name) > 1}):
        raise StudyError(f"values: two columns are named '{twice[0]}'; drop one")
    try:
        cells = given.to_numpy(float)
    except (TypeError, ValueError):
        raise StudyError("values: the table has cells that are no numbers; convert them") from None
    if not np.isfinite(cells).all():
        row, column = np.argwhere(~np.isfinite(cells))[0]
        raise StudyError(
            f"values: row {given.index[row]}, parameter '{names[column]}': "
            f"{cells[row, column]} is no finite number; drop the row, or correct it"
        )
    # The rules of the places are limits, so the ends of a column show whether all values keep them.
    for ends in (cells.min(axis=0), cells.max(axis=0)):
        si_values(study, dict(zip(names, ends.tolist(), strict=True)))
    return {
        name: column * study.parameters[name].factor
        for name, column in zip(names, cells.T, strict=True)
    }


def places_of_parameter(study: Study) -> list[Place]:
    """Return the places of the description at which a parameter or an expression stands."""
    return [
        (place, number, rules)
        for root, part in parts_with_numbers(study).items()
        for place, number, rules in numbers(part, root)
        if isinstance(number, str)
    ]


def _check_rules(study: Study, si: Mapping[str, float], places: Iterable[Place]) -> None:
    """Refuse SI values that break a rule of a place, such as a negative density."""
    for place, number, rules in places:
        if number not in si:
            continue
        broken = [rule.text for rule in rules if not rule.holds(si[number])]
        if broken:
            value = si[number] / study.parameters[number].factor
            raise StudyError(f"parameter '{number}': {value:g} {broken[0]} (it is used as {place})")


def _kind(given: object) -> str:
    return f"a {type(given).__name__}"


def check_parameter(study: Study, name: str) -> None:
    """Refuse a name that is no parameter of the study."""
    if not isinstance(name, str) or name not in study.parameters:
        known = suggest(str(name), study.parameters)
        raise StudyError(f"study '{study.name}' has no parameter '{name}'. {known}")


def with_kinetics_of(study: Study, kinetics: str | None) -> Study:
    """Return a study whose curves have the kinetics 'described', 'fitted' or of a published set.

    None leaves them: those that the diagnosis starts from, by default those of `imp`.
    """
    if kinetics is None:
        return study
    known = ["described", "fitted", *(study.kinetics.sets if study.kinetics else ())]
    word_of("kinetics", kinetics, known)
    diagnosis = study.diagnosis.model_copy(update={"kinetics": kinetics})
    return study.model_copy(update={"diagnosis": diagnosis})


def in_units(study: Study, values: Mapping[str, float]) -> dict[str, float]:
    """Return SI values in the units of the study."""
    return {name: value / study.parameters[name].factor for name, value in values.items()}


def complete(
    study: Study, values: Mapping[str, float], experiments: Iterable[str], but: Iterable[str] = ()
) -> dict[str, float]:
    """Return all SI values that experiments need, those that the study gives included.

    Parameters
    ----------
    study
        The study.
    values
        Values of the caller, SI units.
    experiments
        Names of the experiments that are simulated.
    but
        Names that need no value, as they are estimated.

    Raises
    ------
    StudyError
        A parameter has no value.
    """
    every = {**study.fixed_values(), **values}
    lacking = sorted(used_by(study, experiments) - set(every) - set(but))
    if lacking:
        places = ", ".join(_limits(study, name) for name in lacking)
        raise StudyError(
            f"study '{study.name}': no value for {places}; give it, or set `value` in the study"
        )
    return every


def used_by(study: Study, experiments: Iterable[str]) -> set[str]:
    """Return the names of the parameters that experiments show."""
    material = diagnosed_material(study)
    chosen = [study.experiments[name] for name in experiments]
    heated = [e for e in chosen if kind_of(e).stage == "kinetics"]
    used = parameters_in(*chosen)
    if len(heated) < len(chosen):
        return used | parameters_in(material)
    quantities = [e.quantity(signal) for e in heated for signal in e.signals]
    return used | parameters_of_heated(material, quantities)


def _limits(study: Study, name: str) -> str:
    of = study.parameters[name]
    return f"{name} ({of.lower:g} to {of.upper:g} {of.unit})"


def experiments_of(study: Study, given: str | Iterable[str] | None) -> list[str]:
    """Return names of experiments, by default all."""
    if given is None:
        return list(study.experiments)
    try:
        names = [given] if isinstance(given, str) else list(given)
    except TypeError:
        raise StudyError(f"names of experiments are needed; this is {_kind(given)}") from None
    for name in names:
        if not isinstance(name, str) or name not in study.experiments:
            known = suggest(str(name), study.experiments)
            raise StudyError(f"study '{study.name}' has no experiment '{name}'. {known}")
    return names


def signals_of(study: Study, given: Signals) -> list[Key]:
    """Return the pairs of experiment and signal that a caller names.

    >>> import pyrofit as pf
    >>> signals_of(pf.read_study("config/smoke.yaml"), {"slab_25": "mlr"})
    [('slab_25', 'mlr')]
    """
    if not isinstance(given, Mapping):
        alone = isinstance(given, str) or _is_key(study, given)
        listed = [given] if alone else names_given("signals", given)
        return [pair for one in listed for pair in _pairs(study, one)]
    pairs: list[Key] = []
    for name in experiments_of(study, given):
        wanted = given[name]
        wanted = [wanted] if isinstance(wanted, str) else names_given(f"signals of {name}", wanted)
        pairs += [key_of(study, (name, signal)) for signal in wanted]
    return pairs


def names_given(argument: str, given: Any) -> list[Any]:
    """Return the items of an argument that lists names.

    >>> names_given("estimate", ("k", "cp"))
    ['k', 'cp']
    >>> names_given("estimate", 3)
    Traceback (most recent call last):
    pyrofit.errors.StudyError: estimate: a list of names is needed, and this is a int: 3
    """
    if isinstance(given, Iterable):
        return list(given)
    raise StudyError(
        f"{argument}: a list of names is needed, and this is a {type(given).__name__}: {given!r}"
    )


def _is_key(study: Study, given: object) -> bool:
    """Tell whether a tuple is a pair of experiment and signal rather than two experiments."""
    return isinstance(given, tuple) and len(given) == 2 and given[1] not in study.experiments


def _pairs(study: Study, one: Any) -> list[Key]:
    """Return a pair, or all pairs of an experiment."""
    if isinstance(one, tuple):
        return [key_of(study, one)]
    [name] = experiments_of(study, [one])
    return [(name, signal) for signal in study.experiments[name].signals]


def key_of(study: Study, given: object) -> Key:
    """Return experiment and signal; the signal may be left out where there is one only."""
    if isinstance(given, str):
        [name] = experiments_of(study, given)
        return name, only(name, list(study.experiments[name].signals))
    if not (isinstance(given, tuple) and len(given) == 2):
        raise StudyError(f"{given!r} names no series; write ('experiment', 'signal')")
    [name] = experiments_of(study, str(given[0]))
    signals = study.experiments[name].signals
    if given[1] not in signals:
        known = suggest(str(given[1]), signals)
        raise StudyError(f"experiment '{name}' has no signal '{given[1]}'. {known}")
    return name, str(given[1])


def only(name: str, signals: Sequence[str]) -> str:
    """Return the one signal that there is, or refuse."""
    if len(signals) != 1:
        raise StudyError(f"experiment '{name}' has several signals: {', '.join(signals)}; name one")
    return signals[0]
