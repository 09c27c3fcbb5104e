"""Effects of a study, put into its description before it is checked, and those of its truth."""

from collections.abc import Mapping
from typing import Any

from pydantic import TypeAdapter, ValidationError

from pyrofit.config.keys.study import Study
from pyrofit.effects import known_effects
from pyrofit.effects.apply import with_effects
from pyrofit.effects.base import Effect
from pyrofit.experiments import AnyExperiment
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material

_EXPERIMENTS: TypeAdapter[dict[str, Any]] = TypeAdapter(dict[str, AnyExperiment])


def apply_effects(given: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a study's keys with its effects in material and experiments.

    A strength that is not given becomes a parameter, ``<effect>_<strength>``, with the limits of
    the catalogue, to be estimated. The effects move from ``effects`` to ``with_effects``.

    Raises
    ------
    ValueError
        An effect or one of its parameters is unknown, or no experiment can have it.
    """
    if not given.get("effects"):
        return given
    try:
        material = Material.model_validate(given["material"])
        experiments = _EXPERIMENTS.validate_python(given["experiments"])
        chosen = {name: dict(numbers or {}) for name, numbers in given["effects"].items()}
        parameters = dict(given["parameters"])
    except (ValidationError, KeyError, TypeError, ValueError, AttributeError):
        return given  # the checks of the study report the error
    catalogue = known_effects()
    for name, numbers in chosen.items():
        if name in catalogue:
            parameters = _free(name, catalogue[name], numbers) | parameters
    material, experiments = with_effects(material, experiments, chosen)
    return {
        **given,
        "parameters": parameters,
        "material": material,
        "experiments": experiments,
        "effects": {},
        "with_effects": {**given.get("with_effects", {}), **chosen},
    }


def _free(name: str, effect: Effect, numbers: dict[str, Any]) -> dict[str, Any]:
    """Let the strengths that are not given be parameters; return these."""
    made = {}
    for key, quantity in effect.strength.items():
        if key not in numbers:
            numbers[key] = f"{name}_{key}"
            made[numbers[key]] = {
                "unit": quantity.unit,
                "lower": quantity.lower,
                "upper": quantity.upper,
                "label": quantity.label,
            }
    return made


def true_description(study: Study) -> tuple[Material, dict[str, Experiment]]:
    """Return material and computed experiments as they truly are, with the effects of the truth.

    Raises
    ------
    ValueError
        The description cannot have an effect.
    """
    assert study.synthetic is not None
    computed = {
        name: experiment
        for name, experiment in study.experiments.items()
        if any(study.is_computed(name, signal) for signal in experiment.signals)
    }
    return with_effects(study.material, computed, study.synthetic.effects)
