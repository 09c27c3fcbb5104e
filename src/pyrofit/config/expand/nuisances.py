"""Differences between the repeats of a test, as parameters with known values."""

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
"""Standard deviations from that value to the farthest one that is drawn for a twin."""
SIGNALS = "signals"


@dataclass(frozen=True)
class Nuisance:
    """Possible differences between repeats.

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
        1.0, "-", "factor on the thickness", SlabExperiment, "sample", "thickness_factor"
    ),
    "flux_sd": Nuisance(1.0, "-", "factor on the flux", SlabExperiment, "front", "flux_factor"),
    "h_sd_W_m2K": Nuisance(
        0.0,
        "W/(m2 K)",
        "change of the heat transfer coefficient of the front",
        SlabExperiment,
        "front",
        "h_change_W_m2K",
    ),
    "clock_sd_s": Nuisance(0.0, "s", "delay of the records", SlabExperiment, SIGNALS, "delay_s"),
    "lag_sd_s": Nuisance(
        0.0, "s", "lag of the sample's temperature", HeatedExperiment, "", "lag_s"
    ),
    "temperature_sd_K": Nuisance(
        0.0,
        "K",
        "temperature of the sample less the recorded one",
        HeatedExperiment,
        "",
        "temperature_offset_K",
    ),
}
"""By the key of the standard deviation."""


def free_numbers(keys: Keys, name: str, sds: Mapping[str, float], stages: list[str]) -> Keys:
    """Return a study's keys with uncertain numbers of an experiment as parameters of known value.

    Stages estimate them; where none does, everything is as described.

    Raises
    ------
    ValueError
        The description has a parameter in the place, or a parameter of the name exists.
    """
    if not sds or not stages:
        return keys
    made = {key: f"{name}_{key.partition('_sd')[0]}" for key in sds}
    experiment = keys["experiments"][name]
    described = {}
    for key, parameter in made.items():
        if parameter in keys.get("parameters", {}):
            raise ValueError(
                f"parameters.{parameter}: the repeat {name} needs this name for a number of its "
                "own; choose another"
            )
        described[key] = _described(experiment, name, NUISANCES[key])
        experiment = _with(experiment, NUISANCES[key], parameter)
    experiment = {**experiment, "repeat": {**experiment["repeat"], "nuisances": made}}
    added = _parameters(experiment.get("title") or name, sds, made, described)
    keys = {
        **keys,
        "experiments": {**keys["experiments"], name: experiment},
        "parameters": {**keys["parameters"], **added},
        "known": {**(keys.get("known") or {}), **_known(sds, made, described)},
    }
    for stage in stages:
        if stage in ("imp", "kinetics"):
            part = keys[stage]
            keys[stage] = {**part, "estimate": [*part["estimate"], *made.values()]}
    return keys


def _parameters(
    title: str, sds: Mapping[str, float], made: Mapping[str, str], described: Mapping[str, float]
) -> Keys:
    found = {}
    for key, parameter in made.items():
        n, value = NUISANCES[key], described[key]
        reach = REACH * sds[key]
        limits = {"lower": value - reach, "upper": value + reach}
        label = f"{n.label}, {title}"
        found[parameter] = {"unit": n.unit, "value": value, **limits, "label": label}
    return found


def _known(
    sds: Mapping[str, float], made: Mapping[str, str], described: Mapping[str, float]
) -> Keys:
    source = "stated scatter of repeats"
    return {
        parameter: {"value": described[key], "sd": sds[key], "source": source}
        for key, parameter in made.items()
    }


def stages_that_fit(keys: Keys, name: str) -> list[str]:
    """Return the stages that fit an experiment; the diagnosis also where it holds it out."""
    return [stage for stage, names in _fitted(keys).items() if name in names]


def _fitted(keys: Keys) -> dict[str, set[str]]:
    imp, kinetics = keys.get("imp") or {}, keys.get("kinetics") or {}
    diagnosis, validation = keys.get("diagnosis") or {}, keys.get("validation") or {}
    terms = [term for terms in (imp.get("costs") or {}).values() for term in terms]
    fitted = {
        "imp": _named(terms) | set(imp.get("identification") or {}),
        "kinetics": _named(kinetics.get("cost") or ()),
    }
    calibrated = set(diagnosis.get("calibrate") or (fitted["imp"] | fitted["kinetics"]))
    held_out = set(diagnosis.get("hold_out") or validation.get("experiments") or ())
    return {**fitted, "diagnosis": calibrated | held_out}


def _named(terms: Any) -> set[str]:
    return {term.get("experiment") for term in terms if term.get("weight", 1.0) > 0.0}


def _described(experiment: Keys, name: str, nuisance: Nuisance) -> float:
    """Return the number about which a nuisance varies: the one that is described.

    Raises
    ------
    ValueError
        A parameter stands there, or signals have different numbers.
    """
    parts = [experiment] if not nuisance.part else [experiment.get(nuisance.part) or {}]
    if nuisance.part == SIGNALS:
        parts = list(experiment[SIGNALS].values())
    given = list(dict.fromkeys(part.get(nuisance.key, nuisance.null) for part in parts))
    if len(given) != 1 or isinstance(given[0], str):
        shown = " and ".join(repr(value) for value in given)
        raise ValueError(
            f"experiments.{name}: {nuisance.key} is {shown} already, and differs between "
            "repeats; leave out one of the two"
        )
    return float(given[0])


def _with(experiment: Keys, nuisance: Nuisance, parameter: str) -> Keys:
    """Return an experiment with a parameter in the place of a nuisance."""
    own = {nuisance.key: parameter}
    if nuisance.part == SIGNALS:
        signals = {n: {**keys, **own} for n, keys in experiment[SIGNALS].items()}
        return {**experiment, SIGNALS: signals}
    if not nuisance.part:
        return {**experiment, **own}
    return {**experiment, nuisance.part: {**(experiment.get(nuisance.part) or {}), **own}}


def scattered(keys: Keys, sds: Mapping[str, Mapping[str, float]]) -> Keys:
    """Return the keys with a truth drawn for the numbers that differ between computed repeats.

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
            drawn[parameter] = keys["parameters"][parameter]["value"] + of[key] * z
    return {**keys, "synthetic": {**synthetic, "truth": {**drawn, **synthetic["truth"]}}}
