"""What must hold between the parts of a study."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from pyrofit.config.uses import names_in, parameters_in, parameters_of_tga
from pyrofit.errors import suggest
from pyrofit.model.base import FRACTION, Rule, numbers
from pyrofit.model.experiment import Gasification, Tga
from pyrofit.model.material import REST, check_composition

if TYPE_CHECKING:
    from pyrofit.config.study import Study, TermSpec


def check_study(study: Study) -> None:
    """Check numbers, compositions, stages and synthetic data of a study.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    _check_numbers(study)
    _check_compositions(study)
    _check_stages(study)
    _check_values(study)
    _check_published(study)
    _check_synthetic(study)


def _require(ok: bool, place: str, message: str) -> None:
    if not ok:
        raise ValueError(f"{place}: {message}")


def _largest(study: Study, number: float | str) -> float:
    """Return a number, or the most that a parameter can be, in SI units."""
    if not isinstance(number, str):
        return number
    p = study.parameters[number]
    return max(x for x in (p.value, p.upper) if x is not None) * p.factor


def _check_sum(study: Study, shares: Mapping[str, float | str], place: str) -> None:
    """Refuse mass fractions or yields that may add up to more than one."""
    total = sum(_largest(study, share) for share in shares.values() if share != REST)
    _require(
        total <= 1.0 + 1e-9,
        place,
        f"with the upper limits of parameters these add up to {total:g}, above 1; lower a limit",
    )


def _check_numbers(study: Study) -> None:
    described = {
        "material": study.material,
        **{f"experiments.{n}": e for n, e in study.experiments.items()},
    }
    for root, part in described.items():
        for place, value, rules in numbers(part, root):
            for rule in rules:
                if isinstance(value, float):
                    _require(rule.holds(value), place, f"{value:g} {rule.text}")
                else:
                    _check_parameter(study, value, rule, place)


def _check_parameter(study: Study, name: str, rule: Rule, place: str) -> None:
    """Refuse an unknown parameter, or one whose value or limits break the rule of its place."""
    _require(
        name in study.parameters,
        place,
        f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
    )
    p = study.parameters[name]
    for what in ("value", "lower", "upper"):
        given = getattr(p, what)
        _require(
            given is None or rule.holds(given * p.factor),
            f"parameters.{name}.{what}",
            f"{given} {rule.text} (it is used as {place})",
        )


def _check_compositions(study: Study) -> None:
    compositions = {"material.composition": study.material.composition}
    for name, experiment in study.kinds(Gasification).items():
        for i, layer in enumerate(experiment.sample.layers):
            if layer.composition is not None:
                place = f"experiments.{name}.sample.layers.{i}.composition"
                compositions[place] = layer.composition
    for label, chosen in (study.kinetics.sets if study.kinetics else {}).items():
        place = f"kinetics.sets.{label}"
        _require(label not in ("described", "fitted"), place, f"'{label}' is a reserved name")
        missing = set(study.material.reactions) ^ set(chosen.reactions)
        _require(not missing, place, f"reactions differ from the material's: {sorted(missing)}")
        compositions[f"{place}.composition"] = chosen.composition
    for place, composition in compositions.items():
        try:
            check_composition(composition, study.material.components)
        except ValueError as error:
            raise ValueError(f"{place}: {error}") from None
        for name in sorted(names_in(composition)):
            _check_parameter(study, name, FRACTION, place)
        _check_sum(study, composition, place)
    for name, reaction in study.material.reactions.items():
        _check_sum(study, reaction.products, f"material.reactions.{name}.products")


def _check_stages(study: Study) -> None:
    stages: dict[str, tuple[tuple[str, ...], Iterable[TermSpec]]] = {
        "imp": (study.imp.estimate, [t for terms in study.imp.costs.values() for t in terms])
    }
    if study.kinetics is not None:
        stages["kinetics"] = (study.kinetics.estimate, study.kinetics.cost)
        _known(study, study.kinetics.compare, "kinetics.compare", Tga)
    for stage, (estimate, terms) in stages.items():
        _check_estimate(study, stage, estimate)
        _check_terms(study, stage, terms)
    _known(study, study.validation.experiments, "validation.experiments", Gasification)
    choices = {"described", *(("fitted", *study.kinetics.sets) if study.kinetics else ())}
    _require(
        study.imp.kinetics in choices,
        "imp.kinetics",
        f"unknown kinetics '{study.imp.kinetics}'. {suggest(study.imp.kinetics, choices)}",
    )


def _check_estimate(study: Study, stage: str, estimate: tuple[str, ...]) -> None:
    _require(len(set(estimate)) == len(estimate), f"{stage}.estimate", "a name stands twice")
    for name in estimate:
        _require(
            name in study.parameters,
            f"{stage}.estimate",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
        _require(
            study.parameters[name].lower is not None,
            f"parameters.{name}",
            f"{stage} estimates it: give lower and upper limits",
        )


def _check_terms(study: Study, stage: str, terms: Iterable[TermSpec]) -> None:
    wanted = Tga if stage == "kinetics" else Gasification
    for term in terms:
        _known(study, (term.experiment,), f"{stage} cost", wanted)
        signals = study.experiments[term.experiment].signals
        _require(
            term.signal in signals,
            f"{stage} cost",
            f"experiment '{term.experiment}' has no signal '{term.signal}'. "
            + suggest(term.signal, signals),
        )


def _check_published(study: Study) -> None:
    for cost, shown in (study.published.costs if study.published else {}).items():
        for name in shown:
            _require(
                name == "fit" or name in study.parameters,
                f"published.costs.{cost}",
                f"unknown parameter '{name}'. {suggest(name, ('fit', *study.parameters))}",
            )


def _check_values(study: Study) -> None:
    material = study.material_with(study.imp.kinetics)
    given = set(study.fixed_values()) | set(study.imp.estimate)
    if study.imp.kinetics == "fitted" and study.kinetics is not None:
        given |= set(study.kinetics.estimate)
    used = parameters_in(material, *study.kinds(Gasification).values())
    for name in sorted(used - given):
        raise ValueError(
            f"parameters.{name}: neither estimated in imp nor given a value; "
            "add it to imp.estimate or give a value"
        )
    for name in sorted(set(study.imp.estimate) - used):
        raise ValueError(f"imp.estimate: '{name}' has no effect on any gasification experiment")
    if study.kinetics is None:
        return
    given = set(study.fixed_values()) | set(study.kinetics.estimate)
    for label in ("fitted", *study.kinetics.sets):
        for name in sorted(parameters_of_tga(study.material_with(label)) - given):
            raise ValueError(
                f"parameters.{name}: TGA needs it; add it to kinetics.estimate or give a value"
            )
    for name in sorted(set(study.kinetics.estimate) - parameters_of_tga(study.material)):
        raise ValueError(f"kinetics.estimate: '{name}' has no effect on TGA")


def _known(
    study: Study, names: Iterable[str], place: str, wanted: type[Tga] | type[Gasification]
) -> None:
    for name in names:
        _require(
            name in study.experiments,
            place,
            f"unknown experiment '{name}'. {suggest(name, study.experiments)}",
        )
        _require(
            isinstance(study.experiments[name], wanted),
            place,
            f"'{name}' is no {wanted.__name__.lower()} experiment",
        )


def _check_synthetic(study: Study) -> None:
    if not study.is_synthetic:
        return
    if study.synthetic is None:
        raise ValueError("synthetic: a signal has file: synthetic; give synthetic.truth")
    known = set(study.synthetic.truth) | set(study.fixed_values())
    for name in sorted(parameters_in(study.material, *study.experiments.values()) - known):
        raise ValueError(f"synthetic.truth: the true value of '{name}' is missing")
    for name in study.synthetic.truth:
        _require(
            name in study.parameters,
            "synthetic.truth",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
