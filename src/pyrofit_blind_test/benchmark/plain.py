"""A data set's base model and the catalogue of effects in plain words, without pyrofit."""

from typing import Any

import pandas as pd

from pyrofit.config import Study, calibration_channels, candidate_effects
from pyrofit.effects import known_effects
from pyrofit.effects.base import ASSUMED, Effect, Quantity
from pyrofit.model.parameters import UNITS
from pyrofit_blind_test.table import one_name

Keys = dict[str, Any]
_SIGNAL = ("average_s", "timing_s")
_EXPERIMENT = ("laboratory", "signals", "program")
_LEAVES_AS_IT_IS = ("factor", "expansion")
"""Ends of the keys that multiply, and whose value 1 is left out."""


def model_keys(study: Study) -> Keys:
    """Return the base model of a data set, SI units; what vanishes is left out."""
    fitted = {channel.experiment for channel in calibration_channels(study)}
    experiments = {}
    for name, experiment in study.experiments.items():
        given = experiment.model_dump(mode="json", exclude=set(_EXPERIMENT))
        signals = {signal: _signal(study, name, signal) for signal in experiment.signals}
        use = "fit" if name in fitted else "predict"
        experiments[name] = {"use": use, **_present(given), "signals": signals}
    return {
        "parameters": {name: _parameter(study, name) for name in study.parameters},
        "material": _present(study.material.model_dump(mode="json")),
        "experiments": experiments,
        "candidates": list(candidate_effects(study)),
    }


def _parameter(study: Study, name: str) -> Keys:
    """Return limits and known value of a parameter in SI units."""
    parameter = study.parameters[name]
    lower, upper = parameter.bounds_si
    keys: Keys = {"label": parameter.label, "unit": si_unit(parameter.unit)}
    keys |= {"lower": lower, "upper": upper}
    if known := study.known.get(name):
        factor = parameter.factor
        keys |= {"known": known.value * factor, "known_sd": known.sd * factor}
    return keys


def si_unit(unit: str) -> str:
    """Return the SI unit of the same quantity.

    >>> si_unit("kJ/(kg K)"), si_unit("mm"), si_unit("kg/m3")
    ('J/(kg K)', 'm', 'kg/m3')
    """
    return unit if UNITS[unit] == 1.0 else unit.removeprefix("k").removeprefix("m") or unit


def _signal(study: Study, experiment: str, signal: str) -> Keys:
    of = study.experiments[experiment]
    given = {key: getattr(of.signals[signal], key) for key in _SIGNAL}
    column = of.quantity(signal).column
    return {"file": f"{experiment}_{signal}.csv", "column": column, **_present(given)}


def _present(given: Keys) -> Keys:
    """Leave out what is none, empty, zero, or a factor of 1."""
    inner = {key: _inner(value) for key, value in given.items()}
    return {
        key: value
        for key, value in inner.items()
        if value and not (value == 1.0 and key.endswith(_LEAVES_AS_IT_IS))
    }


def _inner(value: Any) -> Any:
    if isinstance(value, list):
        return [_inner(one) for one in value]
    return _present(value) if isinstance(value, dict) else value


def catalogue_table() -> pd.DataFrame:
    """Return one row for each parameter of each effect, the strength first."""
    return pd.DataFrame([row for effect in known_effects().values() for row in _rows(effect)])


def _rows(effect: Effect) -> list[Keys]:
    about = {
        "effect": effect.name,
        "title": effect.title,
        "family": effect.family,
        "group": effect.group,
        "same_as": one_name(effect.name),
        "needs": effect.needs.words,
        "equation": effect.equation,
    }
    return [
        {**about, "role": "strength" if name in effect.strength else "form", **_quantity(name, q)}
        for name, q in effect.quantities.items()
    ]


def _quantity(name: str, quantity: Quantity) -> Keys:
    low, high = quantity.plausible or (None, None)
    return {
        "parameter": name,
        **{key: getattr(quantity, key) for key in ("symbol", "label", "unit", "lower", "upper")},
        "default": quantity.value,
        "typical": quantity.typical,
        "plausible_low": low,
        "plausible_high": high,
        "source": "" if quantity.source == ASSUMED else quantity.source,
    }
