"""Which masses of a study schemes are fitted to, and which they predict."""

from collections.abc import Iterable
from dataclasses import dataclass

from pyrofit.config import Study
from pyrofit.config.uses import parameters_of_heated
from pyrofit.model.heated import HeatedExperiment
from pyrofit.solver.outputs import MASS_FRACTION

Pairs = tuple[tuple[str, str], ...]
FEWEST_RATES = 2
"""Heating rates without which no scheme can be chosen."""
ENOUGH_RATES = 3
"""Heating rates with which a fit without one of them still has two."""


@dataclass(frozen=True)
class Masses:
    """Masses, by experiment and signal, and the parameters of the study's own scheme.

    Parameters
    ----------
    fitted, predicted
        Masses that schemes are fitted to, and those that they predict only.
    estimate
        Parameters of the scheme that the study describes.
    place
        Key of the study that names the fitted masses.
    """

    fitted: Pairs
    predicted: Pairs
    estimate: tuple[str, ...]
    place: str


def masses_of(study: Study) -> Masses:
    """Return the masses of the kinetics stage, or of a study of heated samples alone.

    Fitted are those that the cost compares. Where a study without the stage compares fewer than
    three heating rates, all its masses are fitted: the choice leaves each rate out by itself.
    """
    stage = study.kinetics
    if stage is not None:
        fitted = _masses(study, ((t.experiment, t.signal) for t in stage.channels))
        others = _of_experiments(study, stage.compare)
        return Masses(fitted, _without(others, fitted), stage.estimate, "kinetics.cost")
    fitted = _masses(study, ((t.experiment, t.signal) for t in study.imp.channels))
    others = _of_experiments(study, study.validation.experiments)
    if fitted and len({_rate(study, name) for name, _ in fitted}) < ENOUGH_RATES:
        fitted += _without(others, fitted)
    used = parameters_of_heated(study.material)
    estimate = tuple(name for name in study.imp.estimate if name in used)
    return Masses(fitted, _without(others, fitted), estimate, "imp.costs")


def fitted_rates(study: Study) -> set[float]:
    """Return the heating rates of the masses that schemes are fitted to [K/min]."""
    return {_rate(study, name) for name, _ in masses_of(study).fitted}


def _masses(study: Study, pairs: Iterable[tuple[str, str]]) -> Pairs:
    """Keep the masses of samples that are heated at a rate."""
    return tuple(
        (name, signal)
        for name, signal in pairs
        if isinstance(heated := study.experiments[name], HeatedExperiment)
        and not heated.is_isothermal
        and heated.quantity(signal).name == MASS_FRACTION
    )


def _of_experiments(study: Study, names: Iterable[str]) -> Pairs:
    return _masses(study, ((n, signal) for n in names for signal in study.experiments[n].signals))


def _without(pairs: Pairs, others: Pairs) -> Pairs:
    return tuple(pair for pair in pairs if pair not in others)


def _rate(study: Study, name: str) -> float:
    experiment = study.experiments[name]
    assert isinstance(experiment, HeatedExperiment)
    return experiment.heating_rate_K_min
