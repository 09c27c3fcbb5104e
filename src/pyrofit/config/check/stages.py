"""Rules for the stages of a study."""

from collections.abc import Iterable, Mapping, Sequence

from pyrofit.config.keys.study import Study
from pyrofit.config.keys.terms import TermSpec
from pyrofit.config.words import require
from pyrofit.errors import suggest
from pyrofit.experiments import kinds_of
from pyrofit.experiments.base import Stage
from pyrofit.quantities.base import LIMITS


def check_stages(study: Study) -> None:
    """Check the estimated, fitted and predicted items of each stage.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    check_estimate(study, "imp", study.imp.estimate)
    for cost, terms in study.imp.costs.items():
        _check_terms(study, f"imp.costs.{cost}", terms, "imp")
    if study.kinetics is not None:
        check_estimate(study, "kinetics", study.kinetics.estimate)
        _check_terms(study, "kinetics.cost", study.kinetics.cost, "kinetics")
        _known(study, study.kinetics.compare, "kinetics.compare", "kinetics")
    _known(study, study.imp.identification, "imp.identification", "imp")
    check_choice(study, "imp.identification", study.imp.identification)
    _known(study, study.validation.experiments, "validation.experiments", "imp")
    for name in study.validation.experiments:
        require(
            bool(study.experiments[name].signals),
            "validation.experiments",
            f"'{name}' has no measured signals to compare; take it off the list. Its key "
            "`predicts` is enough.",
        )
    choices = {"described", *(("fitted", *study.kinetics.sets) if study.kinetics else ())}
    require(
        study.imp.kinetics in choices,
        "imp.kinetics",
        f"unknown kinetics '{study.imp.kinetics}'. {suggest(study.imp.kinetics, choices)}",
    )


def check_estimate(study: Study, stage: str, estimate: Sequence[str]) -> None:
    """Check parameters that a stage estimates: that they are known, have limits and stand once.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    require(
        len(set(estimate)) == len(estimate), f"{stage}.estimate", "a name stands twice; delete one"
    )
    for name in estimate:
        require(
            name in study.parameters,
            f"{stage}.estimate",
            f"unknown parameter '{name}'. {suggest(name, study.parameters)}",
        )
        require(
            study.parameters[name].lower is not None,
            f"parameters.{name}",
            f"{stage} estimates it: give lower and upper limits"
            + (", not an expression" if study.parameters[name].expression else ""),
        )


def _check_terms(study: Study, place: str, terms: Sequence[TermSpec], wanted: Stage) -> None:
    require(
        any(term.weight > 0.0 for term in terms),
        place,
        "no term has a weight above 0; give one to at least one of them",
    )
    for i, term in enumerate(terms):
        _known(study, (term.experiment,), f"{place}.{i}.experiment", wanted)
        signals = study.experiments[term.experiment].signals
        require(
            term.signal in signals,
            f"{place}.{i}.signal",
            f"experiment '{term.experiment}' has no signal '{term.signal}'. "
            + suggest(term.signal, signals),
        )
        if term.limits is not None:
            of = f"experiments.{term.experiment}.signals.{term.signal}"
            require(
                not study.is_computed(term.experiment, term.signal),
                f"{place}.{i}.limits",
                f"{of} is computed, and has no columns; leave `limits` out",
            )
            require(
                set(LIMITS) <= set(signals[term.signal].columns),
                f"{place}.{i}.limits",
                f"name the columns lower and upper in {of}.columns, or leave `limits` out",
            )


def check_choice(study: Study, place: str, chosen: Mapping[str, Sequence[str]]) -> None:
    """Check signals chosen by experiment: that they are known, and each stands once.

    Raises
    ------
    ValueError
        With place, rule and way out.
    """
    for name, signals in chosen.items():
        _check_experiment(study, name, place)
        require(bool(signals), f"{place}.{name}", "name at least one signal, or leave it out")
        require(len(set(signals)) == len(signals), f"{place}.{name}", "a signal stands twice")
        known = study.experiments[name].signals
        for signal in signals:
            require(
                signal in known,
                f"{place}.{name}",
                f"experiment '{name}' has no signal '{signal}'. {suggest(signal, known)}",
            )


def _check_experiment(study: Study, name: str, place: str) -> None:
    require(
        name in study.experiments,
        place,
        f"unknown experiment '{name}'. {suggest(name, study.experiments)}",
    )


def _known(study: Study, names: Iterable[str], place: str, wanted: Stage) -> None:
    for name in names:
        _check_experiment(study, name, place)
        require(
            study.serves(name, wanted),
            place,
            f"'{name}' is no {_either(kinds_of(wanted))} experiment. "
            + suggest(name, study.of_stage(wanted)),
        )


def _either(words: Sequence[str]) -> str:
    """Return 'a, b or c'."""
    return " or ".join([", ".join(words[:-1]), words[-1]]) if len(words) > 1 else words[0]
