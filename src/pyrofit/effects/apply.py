"""Effects put into a description."""

from collections.abc import Iterable, Mapping
from typing import TypeVar

from pydantic import ValidationError

from pyrofit.effects import known_effects
from pyrofit.effects.base import Effect, Numbers
from pyrofit.errors import suggest
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material

Kind = TypeVar("Kind", bound=Experiment)


def with_effects(
    material: Material,
    experiments: Mapping[str, Kind],
    chosen: Mapping[str, Numbers],
) -> tuple[Material, dict[str, Kind]]:
    """Return material and experiments with effects, applied in the order of their names.

    Parameters
    ----------
    material, experiments
        The base description.
    chosen
        By effect, its parameters: a number in SI units, or the name of a parameter of the study. A
        strength must be given; a form parameter left out takes its usual value.

    Raises
    ------
    ValueError
        If a name is unknown, a strength is missing, no experiment can have the effect, or what the
        effect sets is set already.
    """
    effects = known_effects()
    _refuse_unknown("effect", chosen, effects)
    changed = dict(experiments)
    for name in sorted(chosen):
        try:
            material, changed = _with(effects[name], material, changed, chosen[name])
        except ValidationError as error:
            said = str(error.errors()[0]["msg"]).removeprefix("Value error, ")
            raise ValueError(f"effect '{name}': {said}") from None
        except ValueError as error:
            raise ValueError(f"effect '{name}': {error}") from error
    return material, changed


def _with(
    effect: Effect, material: Material, experiments: dict[str, Kind], given: Numbers
) -> tuple[Material, dict[str, Kind]]:
    at = _numbers(effect, given)
    if not any(effect.needs(e) for e in experiments.values()):
        raise ValueError(f"no experiment can have it; it needs {effect.needs.words}")
    changed = {
        name: effect.experiment(experiment, at) if effect.needs(experiment) else experiment
        for name, experiment in experiments.items()
    }
    return effect.material(material, at), changed  # type: ignore[return-value]


def _numbers(effect: Effect, given: Numbers) -> Numbers:
    """Return all parameters of an effect, those not given at their usual value."""
    _refuse_unknown("parameter", given, effect.quantities)
    for name in effect.strength:
        if name not in given:
            raise ValueError(f"give its strength '{name}'")
    return {name: quantity.value for name, quantity in effect.form.items()} | dict(given)


def _refuse_unknown(what: str, given: Iterable[str], known: Iterable[str]) -> None:
    for name in given:
        if name not in known:
            raise ValueError(f"unknown {what} '{name}'. {suggest(str(name), known)}")
