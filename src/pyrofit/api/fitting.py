"""Fits of a study to its measurements."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pyrofit.api.choices import (
    Key,
    Signals,
    check_parameter,
    complete,
    in_units,
    names_of,
    si_values,
    signals_of,
    used_by,
    with_kinetics_of,
)
from pyrofit.api.comparison import compared
from pyrofit.api.fit_tables import (
    correlation_table,
    derived_table,
    ends_table,
    estimates_table,
    signals_table,
)
from pyrofit.api.fitted import Fit
from pyrofit.api.measurements import Data, given_keys, measured
from pyrofit.api.searching import check_cost, fit_cost
from pyrofit.api.studies import Source, read_study
from pyrofit.config import (
    Study,
    TermSpec,
    calibration_channels,
    diagnosed_parameters,
    kinetics_of,
)
from pyrofit.errors import StudyError
from pyrofit.estimate.identify import identify
from pyrofit.estimate.jumps import with_noise_of_jumps
from pyrofit.estimate.likelihood import descents
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.estimate.problem import Problem
from pyrofit.experiments import kind_of
from pyrofit.logs import Tell
from pyrofit.seeds import seed_for
from pyrofit.show.goodness import goodness_sentences
from pyrofit.show.text import several
from pyrofit.solver.arrays import FloatArray

Stage = Literal["kinetics", "imp"]
Optimiser = Literal["least_squares", "cmaes", "sceua"]


@dataclass(frozen=True, eq=False)
class Task:
    """Signals to fit and their parameters; all other parameters have values in SI units."""

    study: Study
    channels: tuple[TermSpec, ...]
    estimate: tuple[str, ...]
    fixed: Mapping[str, float]

    @property
    def keys(self) -> list[Key]:
        """Pairs of experiment and signal."""
        return [(c.experiment, c.signal) for c in self.channels]


def fit(
    study: Source,
    data: Data | None = None,
    *,
    signals: Signals | None = None,
    estimate: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    stage: Stage | None = None,
    cost: str | None = None,
    optimiser: Optimiser = "least_squares",
    starts: int = 20,
    profiles: bool = True,
    tell: Tell | None = None,
) -> Fit:
    """Fit parameters of a study to measured series.

    By default all signals that the study fits, and all parameters that it estimates, are fitted
    jointly by maximum likelihood. Computed signals are left out where others are measured. The
    noise of each signal is estimated from the series, unless the study states it. The fit is
    tested: if the model does not describe the signals, no value is determined. Intervals follow
    from the likelihood: linear where chi-square is a parabola, else from profiles.

    Parameters
    ----------
    study
        A study, its file, or its keys.
    data
        Measured series that replace those of the study, as of `read_data`.
    signals
        Experiments, or signals by experiment, that are fitted.
    estimate
        Names of the parameters that are estimated; each needs limits in the study.
    fixed
        Values of parameters that are not estimated, in the units of the study.
    stage
        'kinetics' or 'imp': the signals and the parameters of one stage. Before 'imp', kinetics
        that have no value are fitted, and kept.
    cost
        Name of a cost function of the study: fit that instead, without intervals. Kinetics that
        have no value are fitted first.
    optimiser
        For a cost: 'least_squares', 'cmaes' or 'sceua', with the settings of the study.
    starts
        Points within the limits from which the likelihood is searched: the best four are followed.
    profiles
        Whether intervals follow from profiles where chi-square is no parabola. This may take
        minutes with many parameters, or with some at a limit; linear intervals take seconds.
    tell
        Function that receives messages on the progress of the likelihood, such as ``print``.

    Raises
    ------
    StudyError
        A name is not known, a parameter has no limits or no value, or a fixed value is outside
        its limits.
    DataError
        A measured series is missing, breaks a rule, or is too short to show its noise.
    """
    study = read_study(study)
    values = si_values(study, {} if fixed is None else fixed)
    _check_limits(study, values)
    if not (isinstance(starts, int) and starts >= 1):
        raise StudyError(f"starts: {starts!r} is no count; give a whole number from 1 on")
    if cost is None and optimiser != "least_squares":
        raise StudyError("an optimiser is chosen for a cost only; give `cost`, or leave it out")
    if cost is not None:
        if signals is not None or estimate is not None or stage is not None:
            raise StudyError("a cost has its own signals and parameters; leave out the others")
        check_cost(study, cost, optimiser)
        study = with_kinetics_of(study, study.imp.kinetics)
        return fit_cost(study, data, cost, optimiser, with_kinetics(study, data, values, starts))
    if stage == "kinetics":
        study = with_kinetics_of(study, "fitted")
    if stage == "imp":
        study = with_kinetics_of(study, study.imp.kinetics)
        values = with_kinetics(study, data, values, starts)
    given = given_keys(study, data)
    task = task_of(study, signals, estimate, values, stage, given)
    return fit_likelihood(task, data, starts, profiles, tell or _silent)


def _check_limits(study: Study, fixed: Mapping[str, float]) -> None:
    """Refuse fixed values outside their limits, up to round-off."""
    for name, value in fixed.items():
        parameter = study.parameters[name]
        if parameter.lower is None or parameter.upper is None:
            continue
        own = value / parameter.factor
        near = 1e-9 * (parameter.upper - parameter.lower)
        if not parameter.lower - near <= own <= parameter.upper + near:
            raise StudyError(
                f"fixed: '{name}' is {own:g} {parameter.unit}, outside its limits "
                f"{parameter.lower:g} to {parameter.upper:g}; give a value inside, or widen "
                "`lower` and `upper` in the study"
            )


def task_of(
    study: Study,
    signals: Signals | None,
    estimate: Iterable[str] | None,
    fixed: Mapping[str, float],
    stage: Stage | None,
    given: Collection[Key] = (),
) -> Task:
    """Return the signals to fit and their parameters, checked."""
    channels, names = _default(study, given)
    if stage == "kinetics":
        channels, names = kinetics_of(study).channels, kinetics_of(study).estimate
    elif stage == "imp":
        channels, names = study.imp.channels, study.imp.estimate
    elif stage is not None:
        raise StudyError(f"unknown stage '{stage}'. Known: imp, kinetics.")
    if signals is not None:
        pairs = signals_of(study, signals)
        _refuse_twice("signals", [", ".join(pair) for pair in pairs])
        channels = tuple(TermSpec(experiment=e, signal=s, kind="RMSE") for e, s in pairs)
    experiments = {c.experiment for c in channels}
    if estimate is None:
        shown = used_by(study, experiments)
        names = tuple(name for name in names if name in shown and name not in fixed)
    else:
        names = tuple([estimate] if isinstance(estimate, str) else names_of("estimate", estimate))
        _refuse_twice("estimate", names)
    for name in names:
        check_parameter(study, name)
        if study.parameters[name].lower is None:
            raise StudyError(f"parameter '{name}' has no limits; give `lower` and `upper` to it")
        if name in fixed:
            raise StudyError(f"parameter '{name}' is both fixed and estimated; choose one")
    if not names or not channels:
        raise StudyError("there is nothing to fit; name signals, and parameters to estimate")
    return Task(study, channels, names, complete(study, fixed, experiments, but=names))


def _refuse_twice(key: str, names: Sequence[str]) -> None:
    twice = [name for name in dict.fromkeys(names) if names.count(name) > 1]
    if twice:
        raise StudyError(f"{key}: '{twice[0]}' stands twice; name it once")


def _default(study: Study, given: Collection[Key]) -> tuple[tuple[TermSpec, ...], tuple[str, ...]]:
    """Return the signals that a study fits and the parameters that it estimates.

    Computed signals are left out where others are measured: they are of another sample.
    """
    channels, names = calibration_channels(study), diagnosed_parameters(study)
    pairs = [(c.experiment, c.signal) for c in channels]
    computed = {key for key in pairs if study.is_computed(*key)} - set(given)
    if len(computed) < len(channels):
        channels = tuple(c for c, p in zip(channels, pairs, strict=True) if p not in computed)
    return channels, names


def _silent(text: str) -> None:
    """Tell nothing."""


def fit_likelihood(
    task: Task, data: Data | None, starts: int, profiles: bool = True, tell: Tell = _silent
) -> Fit:
    """Return the fit of highest likelihood with its intervals."""
    study = task.study
    series = measured(study, task.keys, data)
    asked = of_diagnosis(study, task.channels, task.estimate)
    likelihood = pose_likelihood(study, asked, series, task.fixed)
    problem = likelihood.problem
    tell(f"noise of {several(len(series), 'signal')} estimated; {several(starts, 'start')}")
    ends = descents(likelihood, starting_points(study, problem, starts))
    best = ends[0]
    tell(f"chi-square {best.chi2:.1f} of {sum(likelihood.points)} points; intervals follow")
    first = best.x
    likelihood = with_noise_of_jumps(likelihood, [first])
    found = identify(likelihood, [first], profiles)
    x = likelihood.values(found.optimum.x)
    values = problem.values(x)
    scored = compared(study, values, series)
    own = in_units(study, {n: v for n, v in values.items() if n in study.parameters})
    made = Fit(
        study=study,
        method="maximum likelihood",
        values=own,
        table=estimates_table(study, likelihood, found),
        comparison=scored,
        signals=signals_table(scored, likelihood, found),
        correlation=correlation_table(problem.names, found.correlation),
        chi2=found.posterior.chi2,
        freedom=found.posterior.freedom,
        history=ends_table(study, likelihood, ends),
        goodness=found.goodness,
        verdict=tuple(goodness_sentences(study, _stage_of(task), "", found.goodness)),
    )
    return replace(made, derived=derived_table(study, own, made.covariance))


def _stage_of(task: Task) -> Stage:
    """Return the stage that a misfit leads to: 'kinetics' where all samples are heated."""
    stages = {kind_of(task.study.experiments[c.experiment]).stage for c in task.channels}
    return "kinetics" if stages == {"kinetics"} else "imp"


def with_kinetics(
    study: Study, data: Data | None, given: Mapping[str, float], starts: int
) -> dict[str, float]:
    """Return SI values with those of the kinetics, which are fitted where one is missing."""
    stage = study.kinetics
    lacking = set(stage.estimate) - set(given) if stage else set()
    if stage is None or study.imp.kinetics != "fitted" or not lacking:
        return dict(given)
    task = task_of(study, None, None, given, "kinetics")
    found = fit_likelihood(task, data, starts, profiles=False)
    kinetics = {name: found.values[name] for name in stage.estimate}
    return {**si_values(study, kinetics), **given}


def starting_points(study: Study, problem: Problem, count: int) -> list[FloatArray]:
    """Return the middle of the search range and points spread over it, as fractions of it."""
    from scipy.stats import qmc

    rng = np.random.default_rng(seed_for(study.seed, "api", "starts"))
    size = len(problem.names)
    spread = qmc.LatinHypercube(size, seed=rng).random(max(count - 1, 0))
    return [np.full(size, 0.5), *(0.05 + 0.9 * spread)]
