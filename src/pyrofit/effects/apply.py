"""Effects put into a description."""

from collections.abc import Collection, Iterable, Mapping
from typing import TypeVar

from pydantic import ValidationError

from pyrofit.effects import known_effects
from pyrofit.effects.base import Chosen, Effect, Numbers
from pyrofit.errors import suggest
from pyrofit.model.experiment import Experiment
from pyrofit.model.material import Material
from pyrofit.model.slab import SlabExperiment

Kind = TypeVar("Kind", bound=Experiment)
LABORATORIES = "laboratories"
"""Key of a chosen effect: names of the laboratories whose apparatus has it."""


def with_effects(
    material: Material,
    experiments: Mapping[str, Kind],
    chosen: Mapping[str, Chosen],
) -> tuple[Material, dict[str, Kind]]:
    """Return material and experiments with effects, applied in the order of their names.

    Parameters
    ----------
    material, experiments
        The base description.
    chosen
        By effect, its parameters: a number in SI units, or the name of a parameter of the study. A
        strength must be given; a form parameter left out takes its usual value. ``of`` names the
        components that change, by default all of the material itself, see `Material.own`;
        ``laboratories`` those whose experiments change, by default all.

    Raises
    ------
    ValueError
        If a name is unknown, a strength is missing, no experiment can have the effect, or a value
        that the effect sets is set already.
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


def with_shared(
    material: Material, experiments: Mapping[str, Kind], chosen: Mapping[str, Chosen]
) -> dict[str, Kind]:
    """Return further experiments on a material that has its effects already.

    Effects of the material change them as they change those of the study. Effects of the apparatus
    and its surroundings do not: those belong to the laboratories that were fitted.
    """
    changed = dict(experiments)
    for name in sorted(chosen):
        effect = known_effects()[name]
        if not effect.is_shared:
            continue
        numbers = {key: x for key, x in chosen[name].items() if not isinstance(x, tuple | list)}
        at = _numbers(effect, numbers)
        for key, experiment in changed.items():
            inert = effect.of_sample and _is_inert(experiment, material)
            if effect.needs(experiment) and not inert:
                changed[key] = effect.experiment(experiment, at)  # type: ignore[assignment]
    return changed


def _with(
    effect: Effect, material: Material, experiments: dict[str, Kind], given: Chosen
) -> tuple[Material, dict[str, Kind]]:
    of = _components(effect, material, given)
    places = _laboratories(effect, experiments.values(), given)
    at = _numbers(effect, {key: x for key, x in given.items() if not isinstance(x, tuple | list)})
    able = {n for n, e in experiments.items() if effect.needs(e) and e.laboratory in places}
    if effect.of_sample:
        able -= {n for n, e in experiments.items() if _is_inert(e, material)}
    if not able:
        raise ValueError(f"no experiment can have it; it needs {effect.needs.words}")
    changed = {
        name: effect.experiment(experiment, at) if name in able else experiment
        for name, experiment in experiments.items()
    }
    if effect.components is not None:
        material = effect.components(material, at, of)
    return effect.material(material, at), changed  # type: ignore[return-value]


def _components(effect: Effect, material: Material, given: Chosen) -> Collection[str]:
    """Return the components that an effect changes: those named, or those of the material."""
    of = given.get("of")
    if of is None:
        return material.own
    if effect.components is None:
        raise ValueError("it changes no property of components; leave out 'of'")
    if isinstance(of, float | str) or not of:
        raise ValueError("'of' must be a list of components, as [board]")
    _refuse_unknown("component", of, material.components)
    return of


def _laboratories(
    effect: Effect, experiments: Iterable[Experiment], given: Chosen
) -> Collection[str]:
    """Return the laboratories whose experiments an effect changes: those named, or all."""
    known = {e.laboratory for e in experiments}
    named = given.get(LABORATORIES)
    if named is None:
        return known
    if effect.is_shared:
        raise ValueError(
            f"it belongs to the material, which all laboratories share; leave out '{LABORATORIES}'"
        )
    if isinstance(named, float | str) or not named:
        raise ValueError(f"'{LABORATORIES}' must be a list of names, as [UMD]")
    _refuse_unknown("laboratory", named, known)
    return named


def own_laboratories(
    own: Iterable[Experiment], every: Iterable[Experiment]
) -> dict[str, tuple[str, ...]]:
    """Return the key by which effects of the apparatus keep to the laboratories of ``own``.

    It is empty where no other laboratory is among ``every``.

    Examples
    --------
    >>> from pyrofit.experiments import Tga
    >>> one, other = (Tga(kind="tga", heating_rate_K_min=5.0, laboratory=l) for l in ("A", "B"))
    >>> own_laboratories([one], [one, other]), own_laboratories([one], [one])
    ({'laboratories': ('A',)}, {})
    """
    names = dict.fromkeys(e.laboratory for e in own)
    return {LABORATORIES: tuple(names)} if {e.laboratory for e in every} - names.keys() else {}


def _is_inert(experiment: Experiment, material: Material) -> bool:
    """Tell whether an experiment is made on a body that has no component of the material."""
    if not isinstance(experiment, SlabExperiment):
        return False
    layers = [layer.composition for layer in experiment.sample.layers]
    return all(of is not None and not material.own & of.keys() for of in layers)


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
