"""Fits of a study to its measurements."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

import pandas as pd

from pyrofit.api.arguments import count_of, teller_of, word_of
from pyrofit.api.choices import Signals, in_units, si_values, with_kinetics_of
from pyrofit.api.comparison import series_compared
from pyrofit.api.fit_tables import (
    derived_table,
    ends_table,
    estimates_table,
    signals_table,
)
from pyrofit.api.fitted import Fit
from pyrofit.api.measurements import Data, given_keys, read_to_fit
from pyrofit.api.own_cost import OwnCost
from pyrofit.api.searching import check_cost, check_optimiser, fit_cost, fit_own_cost
from pyrofit.api.studies import Source, read_study
from pyrofit.api.tasks import (
    STAGES,
    Stage,
    Task,
    begin_of,
    initial_of,
    starting_points,
    task_of,
    values_within,
)
from pyrofit.api.weighing import Weights, weighted, weights_of
from pyrofit.config import Study
from pyrofit.config.check.oxidised import oxidised
from pyrofit.errors import StudyError
from pyrofit.estimate.bounded_least_squares import Fit as End
from pyrofit.estimate.identify import identify
from pyrofit.estimate.likelihood import Likelihood, descents
from pyrofit.estimate.noise_of_curves import with_noise_of_curves
from pyrofit.estimate.pose import of_diagnosis
from pyrofit.estimate.pose_likelihood import pose_likelihood
from pyrofit.estimate.wrong_model import least_squares
from pyrofit.experiments import kind_of
from pyrofit.logs import Tell
from pyrofit.show.goodness import goodness_sentences, of_one_rate
from pyrofit.show.text import several
from pyrofit.solver.arrays import FloatArray

Optimiser = Literal["least_squares", "cmaes", "sceua"]
LEAST_SQUARES = "least squares, as the model misses the tests"
"""Method of a fit whose values are those of `pyrofit.estimate.wrong_model`."""


def fit(
    study: Source,
    data: Data | None = None,
    *,
    signals: Signals | None = None,
    estimate: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    stage: Stage | None = None,
    initial: Mapping[str, float] | None = None,
    weights: Weights | None = None,
    cost: str | OwnCost | None = None,
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
    initial
        Values of estimated parameters from which the search starts, in the units of the study;
        others start in the middle of their limits. With ``starts=1`` it starts there alone.
    weights
        Weights w of signals in the likelihood, as `signals` names them: a number, or one for each
        point, above 0. Whitened residuals are multiplied by w: the noise counts as 1/w of its size.
    cost
        Name of a cost function of the study: fit that instead, without intervals. Kinetics that
        have no value are fitted first. Or a function of the measured and the simulated values of a
        signal, shape (points,), SI units. It returns residuals, whose norm is the cost, or a
        cost that is not negative. The sum over signals counts; least squares minimise its square.
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
        A name is not known, a parameter has no limits or no value, or a given value is outside
        its limits. A weight is not above 0, or a cost returns no finite numbers.
    DataError
        A measured series is missing, breaks a rule, or is too short to show its noise.

    Warns
    -----
    UserWarning
        The gas around a fitted sample holds oxygen, and the model has no oxidation. Or a record is
        suspect, such as a mass that rises before it falls.
    """
    study = read_study(study)
    values = values_within(study, "fixed", fixed)
    count_of("starts", starts)
    if stage is not None:
        word_of("stage", stage, STAGES)
    word_of("optimiser", optimiser)
    tell = teller_of(tell)
    if cost is None and optimiser != "least_squares":
        raise StudyError("an optimiser is chosen for a cost only; give `cost`, or leave it out")
    if cost is not None:
        check_optimiser(study, optimiser, initial)
        if weights is not None:
            raise StudyError("weights: a cost has its own; leave them out, or leave out `cost`")
    if cost is not None and not callable(cost):
        if signals is not None or estimate is not None or stage is not None:
            raise StudyError("a cost has its own signals and parameters; leave out the others")
        check_cost(study, cost)
        _warn_of_oxygen(study)
        study = with_kinetics_of(study, study.imp.kinetics)
        given = with_kinetics(study, data, values, starts)
        return fit_cost(study, data, cost, optimiser, given, initial)
    if stage == "kinetics":
        study = with_kinetics_of(study, "fitted")
    if stage == "imp":
        study = with_kinetics_of(study, study.imp.kinetics)
        values = with_kinetics(study, data, values, starts)
    task = task_of(study, signals, estimate, values, stage, given_keys(study, data))
    _warn_of_oxygen(study, [channel.experiment for channel in task.channels])
    if callable(cost):
        return fit_own_cost(task, data, cost, optimiser, initial)
    return fit_likelihood(task, data, starts, profiles, tell, initial, weights)


def _warn_of_oxygen(study: Study, fitted: Sequence[str] | None = None) -> None:
    """Warn, as `pyrofit check` does, that the gas at a fitted sample holds oxygen."""
    for sentence in oxidised(study, fitted):
        warnings.warn(f"study '{study.name}': {sentence}", stacklevel=3)


def _silent(text: str) -> None:
    """Tell nothing."""


def fit_likelihood(
    task: Task,
    data: Data | None,
    starts: int,
    profiles: bool = True,
    tell: Tell = _silent,
    initial: Mapping[str, float] | None = None,
    weights: Weights | None = None,
) -> Fit:
    """Return the fit of highest likelihood with its intervals."""
    study, own_weights = task.study, weights_of(task.study, task.keys, weights)
    begin = initial_of(study, task.estimate, initial)
    series = read_to_fit(study, task.keys, data)
    asked = of_diagnosis(study, task.channels, task.estimate)
    unweighted = pose_likelihood(study, asked, series, task.fixed)
    likelihood = weighted(unweighted, own_weights)
    problem = likelihood.problem
    tell(f"noise of {several(len(series), 'signal')} estimated; {several(starts, 'start')}")
    ends = _ends(likelihood, starting_points(study, problem, starts), begin)
    best = ends[0]
    tell(f"chi-square {best.chi2:.1f} of {sum(likelihood.points)} points; intervals follow")
    # As in a run, noise follows the curve of least squares. The likeliest curve may be far from the
    # data where lasting errors allow it.
    _, nearest = least_squares(likelihood, best.x)
    likelihood = weighted(with_noise_of_curves(unweighted, [nearest]), own_weights)
    found = identify(likelihood, [best.x, nearest], profiles)
    x = likelihood.values(found.optimum.x)
    values = problem.values(x)
    scored = series_compared(study, values, series)
    rest = [e.name for e in found.estimates if e.one_rate]
    own = in_units(study, {n: v for n, v in values.items() if n in study.parameters})
    made = Fit(
        study=study,
        method="maximum likelihood" if found.goodness.passes else LEAST_SQUARES,
        values=own,
        table=estimates_table(study, likelihood, found),
        comparison=scored,
        signals=signals_table(scored, likelihood, found),
        correlation=pd.DataFrame(found.correlation, problem.names, problem.names),
        chi2=found.posterior.chi2,
        freedom=found.posterior.freedom,
        history=ends_table(study, likelihood, ends),
        goodness=found.goodness,
        verdict=(
            *goodness_sentences(study, _stage_of(task), "", found.goodness),
            *of_one_rate(rest),
        ),
        weights=own_weights,
    )
    return replace(made, derived=derived_table(study, own, made.covariance))


def _ends(
    likelihood: Likelihood, starts: Sequence[FloatArray], initial: Mapping[str, float]
) -> list[End]:
    """Return the ends of descents, the lowest first; initial values are followed in any case."""
    if not initial:
        return descents(likelihood, starts)
    first = likelihood.descend(likelihood.scaled(begin_of(likelihood.problem, initial)))
    others = descents(likelihood, starts[1:]) if len(starts) > 1 else []
    return sorted([first, *others], key=lambda e: e.chi2)


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
