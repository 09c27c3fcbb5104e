"""Effects of a study, put into its description before it is checked."""

from collections.abc import Mapping
from typing import Any

from pydantic import TypeAdapter, ValidationError

from pyrofit.effects import known_effects
from pyrofit.effects.apply import with_effects
from pyrofit.effects.base import Effect
from pyrofit.model.experiment import AnyExperiment
from pyrofit.model.material import Material

_EXPERIMENTS: TypeAdapter[dict[str, Any]] = TypeAdapter(dict[str, AnyExperiment])


def apply_effects(given: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a study's keys with its effects in material and experiments.

    A strength that is not given becomes a parameter, ``<effect>_<strength>``, with the limits of
    the catalogue, to be estimated. What is put in moves from ``effects`` to ``with_effects``.

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
        return given  # the checks of the study say what is wrong
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
