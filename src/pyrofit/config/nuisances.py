"""What differs between the repeats of a test, as parameters with known values."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from pyrofit.model.experiment import Experiment
from pyrofit.model.heated import HeatedExperiment
from pyrofit.model.slab import SlabExperiment
from pyrofit.seeds import seed_for

Keys = dict[str, Any]
REACH = 4.0
"""Standard deviations from the value of no difference to the limits."""
DRAWN = 3.0
"""The same, to the farthest value that is drawn for a twin."""
SIGNALS = "signals"


@dataclass(frozen=True)
class Nuisance:
    """What may differ between repeats.

    Parameters
    ----------
    null
        Value of no difference.
    unit, label
        Those of the parameter.
    family
        Experiments that have it.
    part, key
        Where it stands in the description: the part of the experiment, or every signal, or itself.
    """

    null: float
    unit: str
    label: str
    family: type[Experiment]
    part: str
    key: str


NUISANCES = {
    "thickness_sd": Nuisance(
        1.0, "-", "thickness over that described", SlabExperiment, "sample", "thickness_factor"
    ),
    "flux_sd": Nuisance(
        1.0, "-", "flux over that described", SlabExperiment, "front", "flux_factor"
    ),
    "clock_sd_s": Nuisance(
        0.0, "s", "time by which the records are late", SlabExperiment, SIGNALS, "delay_s"
    ),
    "lag_sd_s": Nuisance(
        0.0, "s", "lag of the sample's temperature", HeatedExperiment, "", "lag_s"
    ),
    "temperature_sd_K": Nuisance(
        0.0,
        "K",
        "sample's temperature over that recorded",
        HeatedExperiment,
        "",
        "temperature_offset_K",
    ),
}
"""By the key of the standard deviation."""


def free(keys: Keys, name: str, sds: Mapping[str, float]) -> Keys:
    """Return a study's keys with what differs of one repeat as parameters of known value.

    They are estimated by the stages that fit it; where none does, nothing differs.

    Raises
    ------
    ValueError
        The description sets the number already, or a parameter of the name exists.
    """
    stages = [stage for stage, fitted in _fitted(keys).items() if name in fitted]
    if not sds or not stages:
        return keys
    made = {key: f"{name}_{key.partition('_sd')[0]}" for key in sds}
    experiment = keys["experiments"][name]
    for key, parameter in made.items():
        if parameter in keys.get("parameters", {}):
            raise ValueError(
                f"parameters.{parameter}: this is the name of what differs of the repeat {name}; "
                "choose another"
            )
        experiment = _with(experiment, name, NUISANCES[key], parameter)
    experiment = {**experiment, "repeat": {**experiment["repeat"], "nuisances": made}}
    keys = {
        **keys,
        "experiments": {**keys["experiments"], name: experiment},
        "parameters": {**keys["parameters"], **_parameters(name, sds, made)},
        "known": {**(keys.get("known") or {}), **_known(sds, made)},
    }
    for stage in stages:
        if stage in ("imp", "kinetics"):
            part = keys[stage]
            keys[stage] = {**part, "estimate": [*part["estimate"], *made.values()]}
    return keys


def _parameters(name: str, sds: Mapping[str, float], made: Mapping[str, str]) -> Keys:
    found = {}
    for key, parameter in made.items():
        n = NUISANCES[key]
        reach = REACH * sds[key]
        limits = {"lower": n.null - reach, "upper": n.null + reach}
        label = f"{n.label}, repeat {name}"
        found[parameter] = {"unit": n.unit, "value": n.null, **limits, "label": label}
    return found


def _known(sds: Mapping[str, float], made: Mapping[str, str]) -> Keys:
    source = "stated scatter of repeats"
    return {
        parameter: {"value": NUISANCES[key].null, "sd": sds[key], "source": source}
        for key, parameter in made.items()
    }


def _fitted(keys: Keys) -> dict[str, set[str]]:
    """Return the names of the experiments that each stage fits."""
    imp, kinetics = keys.get("imp") or {}, keys.get("kinetics") or {}
    diagnosis = keys.get("diagnosis") or {}
    terms = [term for terms in (imp.get("costs") or {}).values() for term in terms]
    return {
        "imp": _named(terms) | set(imp.get("identification") or {}),
        "kinetics": _named(kinetics.get("cost") or ()),
        "diagnosis": set(diagnosis.get("calibrate") or {}),
    }


def _named(terms: Any) -> set[str]:
    return {term.get("experiment") for term in terms if term.get("weight", 1.0) > 0.0}


def _with(experiment: Keys, name: str, nuisance: Nuisance, parameter: str) -> Keys:
    """Return an experiment with a parameter in the place of a nuisance."""
    if nuisance.part == SIGNALS:
        signals = {
            n: _set(keys, name, nuisance, parameter) for n, keys in experiment[SIGNALS].items()
        }
        return {**experiment, SIGNALS: signals}
    if not nuisance.part:
        return _set(experiment, name, nuisance, parameter)
    part = _set(experiment.get(nuisance.part) or {}, name, nuisance, parameter)
    return {**experiment, nuisance.part: part}


def _set(part: Keys, name: str, nuisance: Nuisance, parameter: str) -> Keys:
    if part.get(nuisance.key, nuisance.null) != nuisance.null:
        raise ValueError(
            f"experiments.{name}: {nuisance.key} is {part[nuisance.key]!r} already, and differs "
            f"between repeats; leave out one of the two"
        )
    return {**part, nuisance.key: parameter}


def scattered(keys: Keys, sds: Mapping[str, Mapping[str, float]]) -> Keys:
    """Return the keys with a truth drawn for what differs between computed repeats.

    Normal with the stated standard deviation, within three of them, by the study's seed.
    """
    synthetic = keys.get("synthetic")
    if not isinstance(synthetic, Mapping) or not isinstance(synthetic.get("truth"), Mapping):
        return keys
    drawn = {}
    for name, of in sds.items():
        for key, parameter in (keys["experiments"][name]["repeat"].get("nuisances") or {}).items():
            seed = seed_for(keys.get("seed", 1), "repeats", name, key)
            z = float(np.clip(np.random.default_rng(seed).standard_normal(), -DRAWN, DRAWN))
            drawn[parameter] = NUISANCES[key].null + of[key] * z
    return {**keys, "synthetic": {**synthetic, "truth": {**drawn, **synthetic["truth"]}}}
