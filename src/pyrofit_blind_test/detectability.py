"""The detectability of a twin's hidden effects, in standard deviations of its noise."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from pyrofit.config import Study, calibration_channels, true_description
from pyrofit.cost import Target
from pyrofit.errors import DataError
from pyrofit.estimate.correlation import Correlation
from pyrofit.estimate.likelihood import Likelihood
from pyrofit.estimate.noise import NoiseModel
from pyrofit.estimate.pose import of_diagnosis, pose
from pyrofit.estimate.prior import NormalPrior
from pyrofit.estimate.problem import Problem
from pyrofit.estimate.targets import Measurements
from pyrofit.model.signal import Noise
from pyrofit.results.diagnosis_schema import OfWindow
from pyrofit.solver.arrays import FloatArray

ACTS = 0.5
"""An effect acts where the best base model misses the truth by more [standard deviations]. A window
of 50 points that are off by as much is just found."""
Channel = tuple[str, str]


@dataclass(frozen=True, eq=False)
class Shortfall:
    """How far the best model of some kind stays from the truth.

    Parameters
    ----------
    size
        Root of the least sum of squared whitened differences [standard deviations].
    start
        The same with the true parameters.
    points
        Number of points.
    differences
        Times [s] and differences over the noise's standard deviation, by (experiment, signal).
    """

    size: float
    start: float
    points: int
    differences: Mapping[Channel, tuple[FloatArray, FloatArray]]


def detectability(
    truth: Study,
    series: Measurements,
    known: Mapping[str, float],
    fitted: Mapping[str, float] | None = None,
) -> Shortfall:
    """Return by how many standard deviations of the noise the best base model misses the truth.

    sqrt(min over x of |L^-1 (base(x) - y) / sd|^2 + |(x_k - truth) / sd_k|^2). y are the noise-free
    curves of the truth, computed by the solver of the fitted model. L and sd are the correlation
    and size of the true noise, the error of the clock included. x are the base parameters, searched
    from the truth and from those of a fit; x_k are those with a known value.

    Parameters
    ----------
    truth
        Study of the truth, with its effects and its noise.
    series
        Measurements, for their times, by (experiment, signal).
    known
        Standard deviations of the parameters with a known value, in their units.
    fitted
        Parameters of the base that was fitted to the measurements, in their units.

    Raises
    ------
    DataError
        A simulation of the truth does not finish.
    """
    return _least(truth, _base(truth, _noise_free(truth, series)), known, fitted)


def unexplained(truth: Study, curves: Measurements, known: Mapping[str, float]) -> Shortfall:
    """Return by how many standard deviations the true model misses noise-free curves.

    As `detectability`, but the model has the effects of the truth, and y are the given curves. For
    curves of another code it is the difference of the two codes that no parameter takes up.

    Raises
    ------
    DataError
        A simulation of the truth does not finish.
    """
    return _least(truth, _true(truth, curves), known)


def located(windows: Iterable[OfWindow], misfit: Shortfall) -> dict[str, int]:
    """Return how many points lie in windows of the base, how many are off, and how many are both.

    A point is off where the base misses the truth by more than `ACTS`. With these counts the F1 of
    the windows is 2 both / (in_windows + off).
    """
    counts = dict.fromkeys(("in_windows", "off", "both"), 0)
    of_base = [window for window in windows if window.model == "base"]
    for (experiment, signal), (time, difference) in misfit.differences.items():
        inside = np.zeros(time.size, dtype=bool)
        for window in of_base:
            if (window.experiment, window.signal) == (experiment, signal):
                inside |= (time >= window.start_s) & (time <= window.end_s)
        off = np.abs(difference) > ACTS
        for name, mask in (("in_windows", inside), ("off", off), ("both", inside & off)):
            counts[name] += int(mask.sum())
    return counts


def _least(
    truth: Study,
    problem: Problem,
    known: Mapping[str, float],
    fitted: Mapping[str, float] | None = None,
) -> Shortfall:
    """Return the least misfit of a problem with noise-free targets.

    It is searched from the truth, and from fitted parameters if there are some.
    """
    values = _true_values(truth, problem)
    index = tuple(problem.names.index(name) for name in known)
    sd = np.array([sd * truth.parameters[name].factor for name, sd in known.items()])
    prior = NormalPrior(index, values[list(index)], sd)
    likelihood = Likelihood(problem, _noise_models(truth, problem), prior)
    start = likelihood.scaled(values)
    starts = [start]
    if fitted is not None:
        starts.append(likelihood.scaled(_values(truth, problem, fitted)))
    end = min((likelihood.descend(x) for x in starts), key=lambda found: found.chi2)
    size, first = (math.sqrt(chi2) for chi2 in (end.chi2, likelihood.chi2(start)))
    return Shortfall(size, first, sum(likelihood.points), _differences(likelihood, end.x))


def _differences(
    likelihood: Likelihood, x: FloatArray
) -> dict[Channel, tuple[FloatArray, FloatArray]]:
    problem = likelihood.problem
    curves = likelihood.curves(x)
    assert curves is not None
    targets = [term.target for _, term in problem.cost.terms]
    return {
        (name, signal): (target.time_s, (curve - target.value) / noise.sd)
        for (name, signal, _), target, curve, noise in zip(
            problem.picks, targets, likelihood.split(curves), likelihood.noise, strict=True
        )
    }


def _true(truth: Study, series: Measurements) -> Problem:
    """Return the problem of the model with the effects of the truth."""
    material, experiments = true_description(truth)
    described = truth.model_copy(update={"experiments": experiments})
    asked = replace(of_diagnosis(truth), material=material)
    return pose(described, asked, series, truth.fixed_values())


def _base(truth: Study, series: Measurements) -> Problem:
    asked = replace(of_diagnosis(truth), material=truth.material)
    return pose(truth, asked, series, truth.fixed_values())


def _noise_free(truth: Study, series: Measurements) -> Measurements:
    """Return the calibrated series with noise-free curves of the truth instead of their values."""
    true = _true(truth, series)
    status, curves = true.simulate(_true_values(truth, true))
    if not status.finished:
        raise DataError(f"the truth cannot be simulated: {status.explanation}; change its effects")
    return {
        (c.experiment, c.signal): series[c.experiment, c.signal].assign(
            **{truth.experiments[c.experiment].quantity(c.signal).column: curve}
        )
        for c, curve in zip(calibration_channels(truth), curves, strict=True)
    }


def _true_values(truth: Study, problem: Problem) -> FloatArray:
    assert truth.synthetic is not None
    return _values(truth, problem, truth.synthetic.truth)


def _values(truth: Study, problem: Problem, given: Mapping[str, float]) -> FloatArray:
    """Return the parameters of a problem, SI units, from those in the units of a study."""
    return np.array([given[name] * truth.parameters[name].factor for name in problem.names])


def _noise_models(truth: Study, base: Problem) -> tuple[NoiseModel, ...]:
    terms = [term for _, term in base.cost.terms]
    return tuple(
        _noise(truth, name, signal, term.target)
        for (name, signal, _), term in zip(base.picks, terms, strict=True)
    )


def _noise(truth: Study, experiment: str, signal: str, clean: Target) -> NoiseModel:
    """Return the true noise, the stated error of the clock included."""
    described = truth.experiments[experiment].signals[signal]
    given: Noise = described.noise
    slope = np.gradient(clean.value, clean.time_s)
    sd = np.hypot(given.sd, described.timing_s * slope)
    return NoiseModel(sd, Correlation(lags=given.autocorrelation, ar=given.ar))
