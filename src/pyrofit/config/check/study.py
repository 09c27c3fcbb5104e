"""Rules between the parts of a study."""

from pyrofit.config.check.compositions import check_compositions
from pyrofit.config.check.effects import check_true_effects
from pyrofit.config.check.numbers import check_numbers, check_parameters
from pyrofit.config.check.places import check_places
from pyrofit.config.check.stages import check_stages
from pyrofit.config.check.unmeasured import unmeasured
from pyrofit.config.expand.programs import externals
from pyrofit.config.keys.study import Study
from pyrofit.config.uses import numbers_in_keys, parameters_in, parameters_of_heated
from pyrofit.config.words import require
from pyrofit.effects import known_effects
from pyrofit.errors import suggest
from pyrofit.experiments import kind_of
from pyrofit.model.experiment import Experiment

MOST_LETTERS = 150
"""Longest name: file systems take 255 bytes, of which endings and a second name need some."""


def check_study(study: Study) -> None:
    """Check numbers, compositions, stages and synthetic data of a study.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    if len(externals(study)) < len(study.experiments) and not study.material.components:
        raise ValueError("material: this key is missing, and is required")
    _check_names(study)
    _check_with_effects(study)
    check_numbers(study)
    check_compositions(study)
    _check_signals(study)
    check_places(study)
    check_stages(study)
    _check_values(study)
    _check_published(study)
    _check_synthetic(study)
    check_parameters(study)


def _check_names(study: Study) -> None:
    """Refuse names of which no file system makes a folder or a file."""
    named = {"name": study.name}
    named |= {f"experiments.{name[:MOST_LETTERS]}": name for name in study.experiments}
    named |= {f"parameters.{name[:MOST_LETTERS]}": name for name in study.parameters}
    named |= {f"imp.costs.{name[:MOST_LETTERS]}": name for name in study.imp.costs}
    for place, name in named.items():
        require(
            len(name) <= MOST_LETTERS,
            place,
            f"a name of {len(name)} characters, too long for the name of a folder; use at most "
            f"{MOST_LETTERS}",
        )


def _check_with_effects(study: Study) -> None:
    catalogue = known_effects()
    for name in study.with_effects:
        require(
            name in catalogue,
            "with_effects",
            f"unknown effect '{name}'. {suggest(name, catalogue)}",
        )


def _check_signals(study: Study) -> None:
    external = externals(study)
    for name, experiment in study.experiments.items():
        require(
            bool(experiment.signals) or name in unmeasured(study),
            f"experiments.{name}.signals",
            f"empty; name a measured quantity: {', '.join(experiment.measurable)}",
        )
        for quantity, signal in experiment.signals.items():
            place = f"experiments.{name}.signals.{quantity}"
            require(
                signal.until_K is None or experiment.quantity(quantity).against_temperature,
                f"{place}.until_K",
                "only a record against temperature has one at each point; use until_s",
            )
            require(
                signal.endothermic == "positive" or experiment.quantity(quantity).has_sign,
                f"{place}.endothermic",
                "only a heat flow has a sign that files choose; leave it out",
            )
            rests_on = experiment.quantity(quantity).rests_on
            require(
                not rests_on
                or name in external
                or any(x != 0.0 for x in numbers_in_keys(study.material, rests_on)),
                place,
                f"every {' and '.join(rests_on)} of the material is 0; give at least one",
            )
            if signal.file == "synthetic":
                _check_spacing(experiment, signal.every, place)


def _check_spacing(experiment: Experiment, every: float, place: str) -> None:
    """Refuse a synthetic record of fewer than three points."""
    span, keys = experiment.synthetic_span
    require(
        span > 2.5 * every,
        f"{place}.every",
        f"{every:g} leaves fewer than 3 points of the {span:g} between them; lower it, or "
        f"change {keys}",
    )


def _check_published(study: Study) -> None:
    for cost, shown in (study.published.costs if study.published else {}).items():
        require(
            cost in study.imp.costs,
            "published.costs",
            f"unknown cost '{cost}'. {suggest(cost, study.imp.costs)}",
        )
        for name in shown:
            require(
                name == "fit" or name in study.parameters,
                f"published.costs.{cost}",
                f"unknown parameter '{name}'. {suggest(name, ('fit', *study.parameters))}",
            )
    for name, (lower, upper) in (study.published.limits if study.published else {}).items():
        require(
            name in study.parameters,
            "published.limits",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
        require(
            lower < upper,
            f"published.limits.{name}",
            f"lower ({lower:g}) must be below upper ({upper:g})",
        )


def _check_values(study: Study) -> None:
    material = study.material_with(study.imp.kinetics)
    given = set(study.fixed_values()) | set(study.imp.estimate)
    if study.imp.kinetics == "fitted" and study.kinetics is not None:
        given |= set(study.kinetics.estimate)
    used = parameters_in(material, *study.of_stage("imp").values())
    for name in sorted(used - given):
        raise ValueError(
            f"parameters.{name}: neither estimated in imp nor given a value; "
            "add it to imp.estimate or give a value"
        )
    for name in sorted(set(study.imp.estimate) - used):
        raise ValueError(f"imp.estimate: '{name}' has no effect on any gasification experiment")
    _check_kinetics_values(study)


def _check_kinetics_values(study: Study) -> None:
    """Refuse parameters that the kinetics lack, and those that their signals do not show."""
    stage, heated = study.kinetics, study.of_stage("kinetics")
    if stage is None:
        return
    given = set(study.fixed_values()) | set(stage.estimate)
    fitted = {(term.experiment, term.signal) for term in stage.cost}
    names = {n for n, _ in fitted} | set(stage.compare)
    shown = {n: e for n, e in heated.items() if n in names}
    words = " or ".join(dict.fromkeys(kind_of(e).words for e in shown.values()))
    quantities = [e.quantity(s) for e in shown.values() for s in e.signals]
    of_records = parameters_in(*heated.values())
    for label in ("fitted", *stage.sets):
        of_material = parameters_of_heated(study.material_with(label), quantities)
        for name in sorted((of_material | of_records) - given):
            raise ValueError(
                f"parameters.{name}: {words} needs it; add it to kinetics.estimate or give a value"
            )
    in_fit = [heated[n].quantity(s) for n, s in fitted]
    seen = parameters_of_heated(study.material, in_fit) | of_records
    for name in sorted(set(stage.estimate) - seen):
        raise ValueError(f"kinetics.estimate: '{name}' has no effect on {words}")


def _check_synthetic(study: Study) -> None:
    if not study.is_synthetic:
        return
    if study.synthetic is None:
        raise ValueError("synthetic: a signal has file: synthetic; give synthetic.truth")
    known = set(study.synthetic.truth) | set(study.fixed_values())
    for name in sorted(parameters_in(study.material, *study.experiments.values()) - known):
        raise ValueError(f"synthetic.truth: the true value of '{name}' is missing; give it")
    for name in study.synthetic.truth:
        require(
            name in study.parameters,
            "synthetic.truth",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
    check_true_effects(study)
