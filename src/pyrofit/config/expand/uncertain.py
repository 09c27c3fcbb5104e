"""Uncertain conditions of single experiments without repeats."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from pyrofit.config.expand.nuisances import NUISANCES, Keys, free_numbers, stages_that_fit
from pyrofit.config.words import in_plain_words
from pyrofit.experiments import KINDS
from pyrofit.model.repeats import Nuisances

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
