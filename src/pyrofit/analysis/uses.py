"""Which data each part of a study uses, and which sets it predicts."""

from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.estimate.optimisers import OPTIMISERS
from pyrofit.results.kinetics import masses_shown
from pyrofit.solver.outputs import MASS_FRACTION

SCEUA = "SCE-UA"


STARTED = tuple(optimiser.words for optimiser in OPTIMISERS.values())
"""Optimisers beside SCE-UA, in words."""


PUBLISHED = "published"


ESTIMATES = "estimates"
"""Label of the answer among sets of parameters."""


LIKELIHOOD = "likelihood"
"""The function that the estimates maximise, where sets name their cost function."""


FITTED = "fitted"


HELD_OUT_SIGNAL = "held-out signal"


HELD_OUT = "held out"


UNKNOWN = "not known"


@dataclass(frozen=True)
class PredictedSet:
    """A parameter set of ``validation/curves.csv``: its label, its cost, and who found it."""

    label: str
    cost: str
    origin: str


def fitted_by(study: Study, cost: str) -> set[tuple[str, str]]:
    """Return the (experiment, signal) pairs that one cost of the inverse modelling compares."""
    return {(t.experiment, t.signal) for t in study.imp.costs[cost] if t.weight > 0.0}


def fitted_experiments(study: Study) -> set[str]:
    """Return the experiments that any cost of the inverse modelling uses."""
    return {name for cost in study.imp.costs for name, _ in fitted_by(study, cost)}


def predicted_signals(study: Study, relative: bool) -> list[tuple[str, str]]:
    """Return the predicted (experiment, signal) pairs, in the study's order.

    Parameters
    ----------
    study
        The study.
    relative
        Whether to return rates, which are scored relative to their mean, or the others.
    """
    wanted = set(study.validation.experiments)
    return [
        (name, signal)
        for name, experiment in study.experiments.items()
        if name in wanted
        for signal in experiment.signals
        if experiment.quantity(signal).relative == relative
    ]


def rate_metrics(study: Study) -> list[str]:
    """Return the names of the scores of the predicted rates, each once."""
    pairs = predicted_signals(study, relative=True)
    return list(dict.fromkeys(study.experiments[name].metric(signal) for name, signal in pairs))


def predicted_sets(study: Study) -> list[PredictedSet]:
    """Return the sets that the validation simulates, in its order and under its labels."""
    sets = [PredictedSet(ESTIMATES, LIKELIHOOD, ESTIMATES)]
    sets += [PredictedSet(cost, cost, SCEUA) for cost in study.imp.costs]
    sets += [PredictedSet(f"{c} {by}", c, by) for by in STARTED for c in study.imp.costs]
    if study.published is not None:
        sets += [
            PredictedSet(f"{cost} {PUBLISHED}", cost, PUBLISHED)
            for cost, table in study.published.costs.items()
            if set(study.imp.estimate) <= set(table)
        ]
    return sets


def predicted_labels(study: Study) -> list[str]:
    """Return the labels of the sets that the validation simulates, in its order."""
    return [chosen.label for chosen in predicted_sets(study)]


def use_of(study: Study, cost: str, experiment: str, signal: str) -> str:
    """Say whether the sets of a cost, or the estimates, were fitted to a signal, or predict it."""
    if cost in study.imp.costs:
        pairs = fitted_by(study, cost)
    elif cost == LIKELIHOOD:
        pairs = {(channel.experiment, channel.signal) for channel in study.imp.channels}
    else:
        return UNKNOWN
    if (experiment, signal) in pairs:
        return FITTED
    return HELD_OUT_SIGNAL if experiment in {name for name, _ in pairs} else HELD_OUT


def rates_in_fit(study: Study) -> list[str]:
    """Return the experiments whose mass the kinetics were fitted to, slowest heating first."""
    if study.kinetics is None:
        return []
    used = {(t.experiment, t.signal) for t in study.kinetics.cost if t.weight > 0.0}
    masses = masses_shown(study)
    return [name for name in all_rates(study) if (name, masses[name]) in used]


def all_rates(study: Study) -> list[str]:
    """Return the experiments whose mass is fitted or compared, slowest heating first."""
    heated = study.of_stage("kinetics")
    return sorted(masses_shown(study), key=lambda name: (heated[name].heating_rate_K_min, name))


def title_of(study: Study, experiment: str) -> str:
    """Return the name of an experiment in figures."""
    return study.experiments[experiment].title or experiment


def mass_signal(study: Study, experiment: str) -> str:
    """Return the signal of an experiment that is its mass over its initial mass."""
    described = study.experiments[experiment]
    return next(s for s in described.signals if described.quantity(s).name == MASS_FRACTION)
